//! T-seams: a vertex of one panel on an edge of another.

use super::{RepairReport, border_edges, border_vertices};
use bowknot_geometry::{Point, distance};
use bowknot_io::Mesh;

/// Rounds of splitting: a new border edge may have vertices on it that the old one had not.
const ROUNDS: usize = 3;
/// Border vertices this near to an end of an edge, as a share of it, do not split it: a sliver would come of
/// it.
const END_SHARE: f64 = 0.02;

/// Splits border triangles where another border vertex lies on their border edge within `distance` [m], so
/// that the edge runs through the vertex.
pub(super) fn split_t_seams(mesh: &mut Mesh, distance: f64, report: &mut RepairReport) {
    for _ in 0..ROUNDS {
        let splits = splits(mesh, distance);
        if splits.is_empty() {
            return;
        }
        report.split_triangles += splits.len();
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
            chain.extend(through);
            chain.push(b);
            if start != a {
                chain.reverse();
            }
            mesh.triangles[triangle as usize] = [chain[0], chain[1], apex];
            mesh.triangles.extend(chain[1..].windows(2).map(|pair| [pair[0], pair[1], apex]));
        }
    }
}

/// A triangle whose border edge runs through other vertices, in their order from the edge's first end.
struct Split {
    triangle: u32,
    edge: [u32; 2],
    through: Vec<u32>,
}

/// At most one split a triangle: a second border edge of it waits for the next round.
fn splits(mesh: &Mesh, distance: f64) -> Vec<Split> {
    let mut vertices: Vec<(u32, Point)> =
        border_vertices(mesh).into_iter().map(|v| (v, mesh.positions[v as usize])).collect();
    vertices.sort_by(|a, b| a.1.x.total_cmp(&b.1.x).then(a.0.cmp(&b.0)));
    let mut splits: Vec<Split> = Vec::new();
    let mut taken = vec![false; mesh.triangles.len()];
    for (edge, triangle) in border_edges(mesh) {
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
        splits.push(Split { triangle, edge, through: through.into_iter().map(|entry| entry.1).collect() });
    }
    splits
}
