//! Elements that stand for nothing.

use super::report::RepairReport;
use bowknot_geometry::{MeshProblem, check_mesh};
use bowknot_io::Mesh;

/// Drops triangles without area or given twice, and strand edges likewise. The first of each stays where it
/// was.
pub(super) fn drop_bad_elements(mesh: &mut Mesh, report: &mut RepairReport) {
    let mut keep = vec![true; mesh.triangles.len()];
    for problem in droppable(mesh) {
        match problem {
            MeshProblem::ZeroArea { triangle, .. } => {
                report.zero_area_triangles +=
                    usize::from(std::mem::replace(&mut keep[triangle as usize], false));
            }
            MeshProblem::RepeatedTriangle { triangle, .. } => {
                report.repeated_triangles +=
                    usize::from(std::mem::replace(&mut keep[triangle as usize], false));
            }
            _ => {}
        }
    }
    report.cut_polygons += mesh.retain_triangles(&keep);

    let before = mesh.strands.len();
    let mut order: Vec<([u32; 2], usize)> =
        mesh.strands.iter().enumerate().map(|(e, &[i, j])| ([i.min(j), i.max(j)], e)).collect();
    order.sort_unstable();
    let mut kept: Vec<usize> = order.chunk_by(|a, b| a.0 == b.0).map(|same| same[0].1).collect();
    let length = |e: usize| mesh.strands[e].map(|v| mesh.positions[v as usize]);
    kept.retain(|&e| {
        let [p, q] = length(e);
        p != q
    });
    kept.sort_unstable();
    mesh.strands = kept.into_iter().map(|e| mesh.strands[e]).collect();
    report.dropped_strands += before - mesh.strands.len();
}

/// The problems of the triangles that dropping them cures.
fn droppable(mesh: &Mesh) -> Vec<MeshProblem> {
    let mut problems = check_mesh(&mesh.positions, &mesh.triangles);
    problems.retain(|p| matches!(p, MeshProblem::ZeroArea { .. } | MeshProblem::RepeatedTriangle { .. }));
    problems
}
