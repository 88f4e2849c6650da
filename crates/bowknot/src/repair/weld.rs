//! Border vertices that lie together become one.

use super::{RepairReport, border_vertices, near_pairs};
use bowknot_geometry::{Point, UnionFind, Vector};
use bowknot_io::Mesh;

/// Places that the report lists.
const LISTED: usize = 10;

/// Welds border vertices nearer than `distance` [unit of the mesh], nearest pairs first; each group moves to its mean. Two
/// vertices of one edge are never welded, neither directly nor through others: no edge collapses.
pub(super) fn weld(mesh: &mut Mesh, distance: f64, report: &mut RepairReport) {
    let border: Vec<(u32, Point)> =
        border_vertices(mesh).into_iter().map(|v| (v, mesh.positions[v as usize])).collect();
    let mut groups = Groups::new(mesh);
    for (_, a, b) in near_pairs(&border, distance) {
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
    mesh.strands.iter_mut().flatten().for_each(rename);
    mesh.particles.iter_mut().for_each(rename);
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
        for [i, j] in edges.chain(mesh.strands.iter().copied()) {
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
