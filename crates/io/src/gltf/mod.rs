//! Scenes of glTF 2.0, `.gltf` and `.glb`: meshes, and their motion by nodes, morph targets and skins.
//!
//! Source: Khronos, "glTF 2.0 Specification", which the section numbers below refer to. The JSON is read with
//! `serde_json`; the accessors are our own, since the crate `gltf` computes their ranges unchecked and says
//! neither which accessor nor which node is at fault.

mod accessors;
mod document;
mod motion;
mod part;
mod scene;
mod write;

pub(crate) use scene::GltfScene;
pub use write::{GltfBody, write_glb};
