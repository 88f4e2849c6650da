//! Reading stages: meshes, curves and points, and how they move.
//!
//! Sources: the schema pages of UsdGeom (Mesh, TetMesh, BasisCurves, Points, Imageable, Xformable) and the
//! pages on time codes and value resolution. One layer is read; what it refers to in other files is not.

mod layer;
mod lexer;
mod part;
mod stage;
mod subset;
mod text;
mod xform;

pub(crate) use stage::Stage;
