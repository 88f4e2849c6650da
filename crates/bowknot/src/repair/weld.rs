//! Vertices that lie together become one.

use super::report::RepairReport;
use bowknot_geometry::{Point, UnionFind, Vector};
use bowknot_io::Mesh;
use std::collections::HashMap;

/// Places that the report lists.
const LISTED: usize = 10;

/// Welds those of `vertices` nearer than `distance` [unit of the mesh], nearest pairs first; each group moves
/// to its mean. Two vertices of one edge are never welded, neither directly nor through others: no edge
/// collapses.
pub(super) fn weld(mesh: &mut Mesh, vertices: &[u32], distance: f64, report: &mut RepairReport) {
    let points: Vec<(u32, Point)> = vertices.iter().map(|&v| (v, mesh.positions[v as usize])).collect();
    let mut groups = Groups::new(mesh);
    for (_, a, b) in near_pairs(&points, distance) {
        groups.join(a, b);
    }

    let representative: Vec<u32> = (0..mesh.positions.len() as u32).map(|v| groups.sets.find(v)).collect();
    let mut sums = vec![(Vector::zeros(), 0_usize); mesh.positions.len()];
    for (v, &root) in representative.iter().enumerate() {
        let sum = &mut sums[root as usize];
        // Relative to the root, so that vertices at one place stay there to the bit.
        sum.0 += mesh.positions[v] - mesh.positions[root as usize];
        sum.1 += 1;
    }
    let welded: Vec<Point> =
        mesh.positions.iter().zip(&sums).map(|(p, (sum, count))| p + sum / (*count).max(1) as f64).collect();
    for (v, &root) in representative.iter().enumerate() {
        let place = welded[root as usize];
        if root != v as u32 {
            report.welded_vertices += 1;
            if report.weld_places.len() < LISTED {
                report.weld_places.push(place.coords.into());
            }
        }
        report.largest_move = report.largest_move.max((mesh.positions[v] - place).norm());
    }
    mesh.positions = welded;
    let rename = |v: &mut u32| *v = representative[*v as usize];
    mesh.triangles.iter_mut().flatten().for_each(rename);
    mesh.tets.iter_mut().flatten().for_each(rename);
    mesh.strands.iter_mut().flatten().for_each(rename);
    mesh.particles.iter_mut().for_each(rename);
    mesh.groups.renumber(|v| Some(representative[v as usize]));
    if let Some(surface) = &mut mesh.surface {
        surface.renumber(|v| representative[v as usize]);
    }
}

/// Disjoint sets of vertices, each with its members and the neighbors that it must not swallow.
struct Groups {
    sets: UnionFind,
    members: Vec<Vec<u32>>,
    /// Vertices that share an edge with a vertex, ascending.
    neighbors: Vec<Vec<u32>>,
}

impl Groups {
    fn new(mesh: &Mesh) -> Self {
        let count = mesh.positions.len();
        let mut neighbors = vec![Vec::new(); count];
        let edges = mesh.triangles.iter().flat_map(|&[i, j, k]| [[i, j], [j, k], [k, i]]);
        let of_tets =
            mesh.tets.iter().flat_map(|&[i, j, k, l]| [[i, j], [i, k], [i, l], [j, k], [j, l], [k, l]]);
        for [i, j] in edges.chain(of_tets).chain(mesh.strands.iter().copied()) {
            neighbors[i as usize].push(j);
            neighbors[j as usize].push(i);
        }
        for list in &mut neighbors {
            list.sort_unstable();
            list.dedup();
        }
        Self { sets: UnionFind::new(count), members: (0..count as u32).map(|v| vec![v]).collect(), neighbors }
    }

    /// Joins the groups of two vertices, under the smaller root, if no edge has its ends in both.
    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.sets.find(a), self.sets.find(b));
        let (a, b) = (a.min(b), a.max(b));
        let shares_edge = || {
            let other = |v: &u32| self.members[b as usize].contains(v);
            self.members[a as usize].iter().any(|&v| self.neighbors[v as usize].iter().any(other))
        };
        if a == b || shares_edge() {
            return;
        }
        self.sets.join(a, b);
        let moved = std::mem::take(&mut self.members[b as usize]);
        self.members[a as usize].extend(moved);
    }
}

/// Pairs of points nearer than `distance`, above 0, smaller index first, nearest pairs first. By a grid of
/// cells of that size.
fn near_pairs(points: &[(u32, Point)], distance: f64) -> Vec<(f64, u32, u32)> {
    // Saturates far away, which makes some cells larger.
    let cell = |p: &Point| [p.x, p.y, p.z].map(|c| (c / distance).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut pairs = Vec::new();
    for (k, (a, p)) in points.iter().enumerate() {
        let own = cell(p);
        for shift in 0..27 {
            let near = [shift % 3, shift / 3 % 3, shift / 9].map(|s| s - 1);
            let near = [0, 1, 2].map(|i| own[i].saturating_add(near[i]));
            for (b, q) in cells.get(&near).into_iter().flatten().map(|&other| points[other]) {
                let apart = (p - q).norm();
                if apart <= distance {
                    pairs.push((apart, *a.min(&b), *a.max(&b)));
                }
            }
        }
        cells.entry(own).or_default().push(k);
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    pairs.dedup();
    pairs
}
