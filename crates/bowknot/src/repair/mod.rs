//! Cleaning meshes that no simulation can start from: garments whose panels meet in seams without being
//! joined, and solids with faulty tetrahedra.
//!
//! What is done to surfaces, in this order: vertices at the open borders of surfaces that lie together are
//! welded; a border vertex that lies on another border edge (a T-seam) splits the triangle there; triangles
//! without area and elements given twice are dropped, and vertices that nothing uses. Before and after, the
//! exact judge counts the intersections. What intersects away from borders is left as it is: no weld would
//! cure it.
//!
//! Polygons, texture coordinates and names of an OBJ stay with their faces. Corners that are welded keep
//! their own texture coordinates and normals; a vertex on a T-seam gets texture coordinates between those of
//! the edge.

mod borders;
mod clean;
mod report;
mod seams;
mod solid;
mod solid_report;
#[cfg(test)]
mod tests;
mod verdict;
mod weld;

pub use report::{RepairError, RepairParams, RepairReport};
pub use solid_report::{Found, SolidRepair};
pub use verdict::{PartIntersections, Verdict};

use borders::{border_vertices, mean_border_edge};
use bowknot_io::Mesh;
use verdict::judge;

/// The default weld distance over the mean border edge.
const WELD_SHARE: f64 = 0.01;

/// Repairs a mesh; see the [module](self) for what is done. Deterministic.
///
/// # Errors
/// Neither triangles nor tetrahedra, a weld distance that is no length, coordinates beyond the judge's range.
pub fn repair(mesh: &Mesh, params: &RepairParams) -> Result<(Mesh, RepairReport), RepairError> {
    if mesh.triangles.is_empty() && mesh.tets.is_empty() {
        return Err(RepairError::NoElements);
    }
    if let Some(distance) = params.weld_distance.filter(|d| !(d.is_finite() && *d > 0.0)) {
        return Err(RepairError::WeldDistance(distance));
    }
    if !mesh.tets.is_empty() {
        return solid::repair(mesh, params);
    }
    // A mesh that repeats a vertex within a triangle is not judged as it is, but can be repaired.
    let mut report = RepairReport { before: judge(mesh).ok(), ..RepairReport::default() };
    let mut mesh = mesh.clone();
    if params.drop_lines {
        report.dropped_strands = std::mem::take(&mut mesh.strands).len();
    }
    // First, so that a triangle given twice does not hide a border, nor one without area make one.
    clean::drop_bad_elements(&mut mesh, &mut report);
    report.unused_vertices = mesh.drop_unused_vertices();
    let distance = params.weld_distance.unwrap_or_else(|| WELD_SHARE * mean_border_edge(&mesh));
    report.weld_distance = distance;
    let border = border_vertices(&mesh.triangles);
    weld::weld(&mut mesh, &border, distance, &mut report);
    clean::drop_bad_elements(&mut mesh, &mut report);
    seams::split_t_seams(&mut mesh, distance, &mut report);
    clean::drop_bad_elements(&mut mesh, &mut report);
    mesh.drop_unused_vertices();
    report.lines = mesh.strands.len();
    report.after = judge(&mesh)?;
    Ok((mesh, report))
}
