//! Meshes of any format, told apart by the ending of the file's name.

use crate::error::{IoError, Place};
use crate::import::Import;
use crate::medit::{read_medit, refuse_binary};
use crate::mesh::Mesh;
use crate::msh::read_msh;
use crate::obj::{read_obj, read_segments};
use crate::ply::read_ply;
use crate::still::{is_still, read_still};
use crate::stl::read_stl;
use crate::tet_list::read_tet_list;
use crate::tetgen::read_tetgen;
use crate::vtu::read_vtu;
use std::path::Path;

/// Endings of the files that [`read_mesh`] reads, in lower case.
pub const MESH_ENDINGS: [&str; 14] =
    ["obj", "ply", "stl", "msh", "mesh", "node", "ele", "vtu", "t", "seg", "usda", "usd", "gltf", "glb"];

/// Reads a mesh file, told apart by the ending of its name: OBJ, PLY, STL, Gmsh's MSH, Medit's `.mesh`,
/// TetGen's `.node` and `.ele`, VTK's VTU, lists of tetrahedra (`.t`), strand segments (`.seg`), USD stages and
/// glTF scenes where nothing moves. [`read_mesh_part`](crate::read_mesh_part) reads one part of a file.
///
/// # Errors
/// A missing, malformed or truncated file, numbers that are not finite, indices out of range, an unknown
/// ending.
pub fn read_mesh(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    let ending = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match ending.as_str() {
        "obj" => read_obj(path, import),
        "ply" => read_ply(path, import),
        "stl" => read_stl(path, import),
        "msh" => read_msh(path, import),
        "mesh" => read_medit(path, import),
        "meshb" => Err(refuse_binary(path)),
        "node" | "ele" => read_tetgen(path, import),
        "vtu" => read_vtu(path, import),
        "t" => read_tet_list(path, import),
        "seg" => read_segments(path, import),
        stage if is_still(stage) => read_still(path, import),
        _ => {
            let endings = MESH_ENDINGS.map(|ending| format!(".{ending}")).join(", ");
            Err(IoError::content(path, Place::File, format!("not a mesh: only {endings} files are read")))
        }
    }
}
