#![doc = include_str!("../README.md")]
//!
//! ## Faulty elements
//!
//! Elements are kept as they stand in the file, degenerate ones too. Whether a triangle of zero area is an
//! error or a warning depends on the body, which a scene knows and a file does not.
//!
//! The readers are our own because the crates at hand do not say where a file is wrong (`tobj`) or refuse
//! numbers that exporters write, such as `1.` (`ply-rs-bw`); both serve as oracles in the tests.

mod animation;
mod atomic;
mod elements;
mod error;
mod field;
mod folder;
mod frame_source;
mod gltf;
mod groups;
mod import;
mod medit;
mod mesh;
mod msh;
#[cfg(feature = "npz")]
pub mod npz;
mod numbering;
mod obj;
mod parts;
mod pc2;
mod pick;
mod ply;
mod read;
mod still;
mod stl;
mod surface;
mod tet_list;
mod tetgen;
mod transform;
mod usd;
mod vtu;

/// Points and topology, the types that meshes are made of.
pub use bowknot_geometry as geometry;

pub use animation::FrameOptions;
pub use atomic::{create_folder, write_atomic, write_text};
pub use error::{IoError, Place};
pub use field::{Field, FieldValues};
pub use folder::files_in;
pub use frame_source::FrameSource;
pub use gltf::{GltfBody, write_glb};
pub use groups::Groups;
pub use import::{Import, Up};
pub use mesh::{Mesh, MeshView};
pub use msh::write_msh;
#[cfg(feature = "npz")]
pub use npz::{FrameStack, write_frame_stack, write_frame_stack_with_fields};
pub use obj::{read_obj, read_obj_surface, write_obj};
pub use pc2::{truncate_pc2, write_pc2_frame};
pub use pick::read_mesh_part;
pub use ply::{read_ply, write_ply};
pub use read::{MESH_ENDINGS, read_mesh, read_mesh_bytes};
pub use surface::{Corner, EdgeSplit, Labels, Polygon, PolygonFaults, Surface};
pub use tet_list::write_tet_list;
pub use usd::{UsdBody, write_usda, write_usda_with_fields};
pub use vtu::{write_pvd, write_vtu, write_vtu_with_fields};

#[cfg(all(test, feature = "npz"))]
mod tests;
