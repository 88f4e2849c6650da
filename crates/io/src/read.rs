//! Meshes of any format, told apart by the ending of the file's name.

use crate::error::{IoError, Place};
use crate::frame_source::read_still;
use crate::import::Import;
use crate::mesh::Mesh;
use crate::msh::read_msh;
use crate::obj::{read_obj, read_segments};
use crate::ply::read_ply;
use crate::tet_list::read_tet_list;
use std::path::Path;

/// Endings of the files that [`read_mesh`] reads, in lower case.
pub const MESH_ENDINGS: [&str; 9] = ["obj", "ply", "msh", "t", "seg", "usda", "usd", "gltf", "glb"];

/// Reads a mesh file, told apart by the ending of its name: OBJ, PLY, Gmsh's MSH, lists of tetrahedra (`.t`),
/// strand segments (`.seg`), USD stages and glTF scenes where nothing moves.
///
/// # Errors
/// A missing, malformed or truncated file, numbers that are not finite, indices out of range, an unknown
/// ending.
pub fn read_mesh(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match ending.as_str() {
        "obj" => read_obj(path, import),
        "ply" => read_ply(path, import),
        "msh" => read_msh(path, import),
        "t" => read_tet_list(path, import),
        "seg" => read_segments(path, import),
        "usda" | "usd" | "usdc" | "usdz" | "gltf" | "glb" => read_still(path, import),
        _ => {
            let endings = MESH_ENDINGS.map(|ending| format!(".{ending}")).join(", ");
            Err(IoError::content(path, Place::File, format!("not a mesh: only {endings} files are read")))
        }
    }
}
