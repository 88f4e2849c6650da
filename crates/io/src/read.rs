//! Meshes of any format, told apart by the ending of the file's name.

use crate::error::{IoError, Place};
use crate::folder::ending;
use crate::import::{Import, read_bytes};
use crate::medit::{read_medit, refuse_binary};
use crate::mesh::Mesh;
use crate::msh::read_msh;
use crate::obj::{parse_obj, read_segments};
use crate::ply::parse_ply;
use crate::still::{is_still, read_still};
use crate::stl::read_stl;
use crate::tet_list::read_tet_list;
use crate::tetgen::read_tetgen;
use crate::vtu::read_vtu;
use bowknot_errors::Parameters;
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
    match ending(path).as_str() {
        "node" | "ele" => read_tetgen(path, import),
        stage if is_still(stage) => read_still(path, import),
        _ => match reader(path) {
            Some(read) => read(path, &read_bytes(path, import)?, import),
            None => Err(unknown(path)),
        },
    }
}

/// As [`read_mesh`], from the `bytes` of a file instead of the disk: of OBJ, PLY, STL, MSH, Medit's `.mesh`, VTU, `.t`
/// and `.seg`. Its `name` tells the format and stands in messages.
///
/// # Errors
/// As [`read_mesh`]; formats of several files and of animations, which are read from a disk alone.
pub fn read_mesh_bytes(name: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    import.validate().map_err(|errors| IoError::content(name, Place::File, errors.to_string()))?;
    match reader(name) {
        Some(read) => read(name, bytes, import),
        None if MESH_ENDINGS.contains(&ending(name).as_str()) => {
            let message = "files of this format are read from a disk alone: convert it to OBJ or PLY";
            Err(IoError::content(name, Place::File, message))
        }
        None => Err(unknown(name)),
    }
}

/// Reads the bytes of a file; its path is for messages.
type Reader = fn(&Path, &[u8], &Import) -> Result<Mesh, IoError>;

/// The reader of a format that is a single file, by the ending of its name.
fn reader(path: &Path) -> Option<Reader> {
    Some(match ending(path).as_str() {
        "obj" => parse_obj,
        "ply" => parse_ply,
        "stl" => read_stl,
        "msh" => read_msh,
        "mesh" => read_medit,
        "vtu" => read_vtu,
        "t" => read_tet_list,
        "seg" => read_segments,
        _ => return None,
    })
}

fn unknown(path: &Path) -> IoError {
    if ending(path) == "meshb" {
        return refuse_binary(path);
    }
    let endings = MESH_ENDINGS.map(|ending| format!(".{ending}")).join(", ");
    IoError::content(path, Place::File, format!("not a mesh: only {endings} files are read"))
}
