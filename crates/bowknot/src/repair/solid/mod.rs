//! Solids: tetrahedral meshes.
//!
//! What is done, in this order: vertices that lie together become one; tetrahedra that name a vertex twice or
//! repeat another are dropped; flat ones are dropped where nothing else meets there, and are collapsed
//! otherwise; vertices are ordered so that all volumes are positive; of tetrahedra on the same side of a face
//! one is dropped; so are triangles, lines and points that are parts of tetrahedra, and vertices that nothing
//! uses. Thin tetrahedra are counted and stay.

mod flat;
mod overlaps;
#[cfg(test)]
mod tests;

use super::report::{RepairError, RepairParams, RepairReport};
use super::solid_report::SolidRepair;
use super::verdict::judge;
use super::weld;
use bowknot_geometry::tet_check::{check_tets, signed_volume, thinness};
use bowknot_geometry::{Point, Vector};
use bowknot_io::Mesh;
use std::collections::HashSet;

/// The default weld distance over the mean edge: above the rounding of files in single precision, far below
/// what a mesh resolves.
const WELD_SHARE: f64 = 1e-4;
/// A tetrahedron is thin if its smallest height is a smaller share of its longest edge.
const THIN: f64 = 0.01;

/// Repairs the tetrahedra of a mesh; see the [module](self).
pub(super) fn repair(mesh: &Mesh, params: &RepairParams) -> Result<(Mesh, RepairReport), RepairError> {
    let mut report = RepairReport { before: judge(mesh).ok(), ..RepairReport::default() };
    let mut solid = SolidRepair { volume: [volume(mesh), 0.0], ..SolidRepair::default() };
    let mut mesh = Mesh { surface: None, ..mesh.clone() };

    report.unused_vertices = mesh.drop_unused_vertices();
    drop_repeated(&mut mesh, &mut solid);
    report.weld_distance = params.weld_distance.unwrap_or_else(|| WELD_SHARE * mean_edge(&mesh));
    let all: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    weld::weld(&mut mesh, &all, report.weld_distance, &mut report);
    drop_repeated(&mut mesh, &mut solid);
    flat::collapse(&mut mesh, &mut solid);
    drop_repeated(&mut mesh, &mut solid);
    for index in check_tets(&mesh.positions, &mesh.tets).turned {
        solid.turned.add(center(&mesh.positions, &mesh.tets[index]));
        mesh.tets[index].swap(2, 3);
    }
    overlaps::drop_overlapping(&mut mesh, &mut solid);
    drop_parts(&mut mesh, params, &mut solid, &mut report);
    mesh.drop_unused_vertices();

    for tet in &mesh.tets {
        let thinness = thinness(&tet.map(|v| mesh.positions[v as usize]));
        let place = center(&mesh.positions, tet);
        if thinness < THIN {
            solid.thin.add(place);
        }
        if solid.thinnest.is_none_or(|(least, _)| thinness < least) {
            solid.thinnest = Some((thinness, place.coords.into()));
        }
    }
    mesh.triangles.iter().for_each(|triangle| solid.triangles.add(center(&mesh.positions, triangle)));
    solid.volume[1] = volume(&mesh);
    report.lines = mesh.strands.len();
    report.after = judge(&mesh)?;
    report.solid = Some(solid);
    Ok((mesh, report))
}

/// Drops tetrahedra that name a vertex twice, and all but the first of those with the same vertices.
fn drop_repeated(mesh: &mut Mesh, solid: &mut SolidRepair) {
    let mut seen = HashSet::new();
    let positions = &mesh.positions;
    mesh.tets.retain(|tet| {
        let mut key = *tet;
        key.sort_unstable();
        let place = center(positions, tet);
        if key.windows(2).any(|pair| pair[0] == pair[1]) {
            solid.repeated_vertices.add(place);
            return false;
        }
        let is_new = seen.insert(key);
        if !is_new {
            solid.repeated_tets.add(place);
        }
        is_new
    });
}

/// Drops triangles, lines and points that are parts of tetrahedra, and the others if that was asked for. A
/// line or triangle that names a vertex twice is one of them.
fn drop_parts(mesh: &mut Mesh, params: &RepairParams, solid: &mut SolidRepair, report: &mut RepairReport) {
    let (mut faces, mut edges) = (HashSet::new(), HashSet::new());
    for &tet in &mesh.tets {
        let [a, b, c, d] = sorted(tet);
        faces.extend([[a, b, c], [a, b, d], [a, c, d], [b, c, d]]);
        edges.extend([[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]);
    }
    let (triangles, lines) = (mesh.triangles.len(), mesh.strands.len());
    mesh.triangles.retain(|&triangle| {
        let [a, b, c] = sorted(triangle);
        !params.drop_triangles && a != b && b != c && !faces.contains(&[a, b, c])
    });
    mesh.strands.retain(|&line| {
        let [a, b] = sorted(line);
        !params.drop_lines && a != b && !edges.contains(&[a, b])
    });
    mesh.particles.clear();
    solid.dropped_triangles = triangles - mesh.triangles.len();
    report.dropped_strands = lines - mesh.strands.len();
}

fn sorted<const N: usize>(mut vertices: [u32; N]) -> [u32; N] {
    vertices.sort_unstable();
    vertices
}

/// The mean of the corners.
fn center(positions: &[Point], vertices: &[u32]) -> Point {
    let share = vertices.len() as f64;
    Point::from(vertices.iter().fold(Vector::zeros(), |sum, &v| sum + positions[v as usize].coords / share))
}

/// Sum of the volumes of the tetrahedra, each positive [unit of the mesh, cubed].
fn volume(mesh: &Mesh) -> f64 {
    mesh.tets.iter().map(|tet| signed_volume(&tet.map(|v| mesh.positions[v as usize])).abs()).sum()
}

/// Mean length of the edges of the tetrahedra, each counted per tetrahedron [unit of the mesh]; 0 if there
/// are none.
fn mean_edge(mesh: &Mesh) -> f64 {
    let lengths = mesh.tets.iter().flat_map(|tet| {
        let [a, b, c, d] = tet.map(|v| mesh.positions[v as usize]);
        [b - a, c - a, d - a, c - b, d - b, d - c].map(|edge| edge.norm())
    });
    lengths.sum::<f64>() / (6 * mesh.tets.len()).max(1) as f64
}
