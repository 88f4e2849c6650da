//! T-seams: a vertex of one panel on an edge of another.

use super::borders::{border_edges, border_vertices};
use super::report::RepairReport;
use bowknot_geometry::{Point, distance};
use bowknot_io::{EdgeSplit, Mesh};

/// Rounds of splitting: a new border edge may have vertices on it that the old one had not.
const ROUNDS: usize = 3;
/// Border vertices this near to an end of an edge, as a share of it, do not split it: a sliver would come of
/// it.
const END_SHARE: f64 = 0.02;

/// Splits border triangles where another border vertex lies on their border edge within `distance` [unit of
/// the mesh], so that the edge runs through the vertex.
pub(super) fn split_t_seams(mesh: &mut Mesh, distance: f64, report: &mut RepairReport) {
    for _ in 0..ROUNDS {
        let splits = splits(mesh, distance);
        if splits.is_empty() {
            return;
        }
        report.split_triangles += splits.len();
        report.cut_polygons += split_surface(mesh, &splits);
        for Split { triangle, edge: [a, b], through } in splits {
            let corners = mesh.triangles[triangle as usize];
            let Some(place) = (0..3).find(|&k| {
                let pair = [corners[k], corners[(k + 1) % 3]];
                pair == [a, b] || pair == [b, a]
            }) else {
                continue;
            };
            let (start, apex) = (corners[place], corners[(place + 2) % 3]);
            let mut chain: Vec<u32> = vec![a];
            chain.extend(through.iter().map(|(_, v)| v));
            chain.push(b);
            if start != a {
                chain.reverse();
            }
            mesh.triangles[triangle as usize] = [chain[0], chain[1], apex];
            mesh.triangles.extend(chain[1..].windows(2).map(|pair| [pair[0], pair[1], apex]));
        }
    }
}

/// Does to the polygons of the mesh, if it has any, what is then done to its triangles. Returns how many
/// larger polygons are cut.
fn split_surface(mesh: &mut Mesh, splits: &[Split]) -> usize {
    let Some(surface) = &mut mesh.surface else { return 0 };
    let mut alone = vec![false; mesh.triangles.len()];
    splits.iter().for_each(|split| alone[split.triangle as usize] = true);
    let cut = surface.isolate_triangles(&alone);
    let splits: Vec<EdgeSplit> = splits
        .iter()
        .filter_map(|&Split { triangle, edge: [a, b], ref through }| {
            let corners = mesh.triangles[triangle as usize];
            let place = |edge: [u32; 2]| (0..3).find(|&k| [corners[k], corners[(k + 1) % 3]] == edge);
            let along = through.iter().map(|&(share, vertex)| (vertex, share));
            let back = through.iter().rev().map(|&(share, vertex)| (vertex, 1.0 - share));
            let forward = place([a, b]).map(|start| (start, along.collect()));
            let (start, through) = forward.or_else(|| Some((place([b, a])?, back.collect())))?;
            Some(EdgeSplit { triangle, start, through })
        })
        .collect();
    surface.split_triangles(&splits);
    cut
}

/// A triangle whose border edge runs through other vertices, in their order from the edge's first end, each
/// with its place on the edge, from 0 to 1.
struct Split {
    triangle: u32,
    edge: [u32; 2],
    through: Vec<(f64, u32)>,
}

/// At most one split a triangle: a second border edge of it waits for the next round.
fn splits(mesh: &Mesh, distance: f64) -> Vec<Split> {
    let mut vertices: Vec<(u32, Point)> =
        border_vertices(&mesh.triangles).into_iter().map(|v| (v, mesh.positions[v as usize])).collect();
    vertices.sort_by(|a, b| a.1.x.total_cmp(&b.1.x).then(a.0.cmp(&b.0)));
    let mut splits: Vec<Split> = Vec::new();
    let mut taken = vec![false; mesh.triangles.len()];
    for (edge, triangle) in border_edges(&mesh.triangles) {
        if taken[triangle as usize] {
            continue;
        }
        let [p, q] = edge.map(|v| mesh.positions[v as usize]);
        let corners = mesh.triangles[triangle as usize];
        let first = vertices.partition_point(|(_, x)| x.x < p.x.min(q.x) - distance);
        let near = vertices[first..].iter().take_while(|(_, x)| x.x <= p.x.max(q.x) + distance);
        let mut through: Vec<(f64, u32)> = near
            .filter(|(v, _)| !corners.contains(v))
            .filter_map(|(v, x)| {
                let closest = distance::vertex_edge(x, [&p, &q]);
                let share = (x - p).dot(&(q - p)) / (q - p).norm_squared();
                let inside = share > END_SHARE && share < 1.0 - END_SHARE;
                (closest.distance <= distance && inside).then_some((share, *v))
            })
            .collect();
        if through.is_empty() {
            continue;
        }
        taken[triangle as usize] = true;
        through.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        splits.push(Split { triangle, edge, through });
    }
    splits
}
