//! Intersecting elements as a mesh file.

use bowknot::check::OffendingMesh;
use bowknot::io::{IoError, MeshView, write_obj, write_ply};
use std::path::Path;

/// Writes the elements with the attributes of their vertices, as OBJ if the file has that extension and as
/// PLY otherwise.
pub fn write(path: &Path, mesh: &OffendingMesh, obstacle: &[bool], body: &[u32]) -> Result<(), IoError> {
    let view = MeshView {
        positions: &mesh.positions,
        triangles: &mesh.triangles,
        strands: &mesh.edges,
        obstacle,
        body,
        ..MeshView::default()
    };
    write_view(path, &view)
}

/// Writes a mesh, as OBJ if the file has that extension and as PLY otherwise.
pub fn write_view(path: &Path, view: &MeshView<'_>) -> Result<(), IoError> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj")) {
        write_obj(path, view)
    } else {
        write_ply(path, view)
    }
}
