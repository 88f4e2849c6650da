//! Which ends of strands are their roots.

use super::WorldBody;
use crate::pin::RootEnd;
use bowknot_errors::counted;
use bowknot_geometry::Point;
use bowknot_geometry::distance::vertex_triangle;
use std::collections::HashSet;

/// Strands that are looked at for a warning, at most.
const LOOKED_AT: usize = 50;

/// Distance from an obstacle within which an end may be a root, in the distance of both ends.
const NEAR: f64 = 0.25;

/// The obstacles at time 0.
pub(super) struct Surroundings<'a> {
    /// The triangles of all bodies; those of obstacles are at vertices from `first_vertex` on.
    pub triangles: &'a [[u32; 3]],
    pub first_vertex: u32,
    /// Of all vertices [m].
    pub positions: &'a [Point],
}

impl Surroundings<'_> {
    /// Distance of a point from the nearest obstacle with a mesh [m]; infinite without any. No roots are in a
    /// half-space.
    fn distance(&self, x: &Point) -> f64 {
        let of_obstacles = self.triangles.iter().filter(|triangle| triangle[0] >= self.first_vertex);
        of_obstacles.fold(f64::INFINITY, |nearest, triangle| {
            let [a, b, c] = triangle.map(|v| &self.positions[v as usize]);
            // No point of the triangle is farther from a than the longer of its two edges there.
            let radius = (b - a).norm().max((c - a).norm());
            if (x - a).norm() > nearest + radius {
                return nearest;
            }
            nearest.min(vertex_triangle(x, [a, b, c]).distance)
        })
    }
}

/// The vertices of strands within `count - 1` edges of their roots, and a warning if some roots seem to be
/// tips.
pub(super) fn roots(
    body: &WorldBody,
    count: usize,
    end: RootEnd,
    surroundings: &Surroundings<'_>,
) -> (Vec<u32>, Option<String>) {
    let strands = Strands::new(body);
    let ends = strands.ends();
    let distance = |v: u32| surroundings.distance(&surroundings.positions[v as usize]);
    let root = |&[first, last]: &[u32; 2]| match end {
        RootEnd::First => first,
        RootEnd::Last => last,
        RootEnd::Nearest if distance(last) < distance(first) => last,
        RootEnd::Nearest => first,
    };
    let held = ends.iter().flat_map(|ends| strands.within(root(ends), count)).collect();
    let warning = (end == RootEnd::First).then(|| {
        let looked_at = || ends.iter().step_by(ends.len().div_ceil(LOOKED_AT).max(1));
        let is_tip = |&&[first, last]: &&[u32; 2]| {
            let [x, y] = [first, last].map(|v| surroundings.positions[v as usize]);
            let (length, of_last) = ((x - y).norm(), distance(last));
            of_last <= NEAR * length && distance(first) > of_last + 0.5 * length
        };
        let (tips, looked_at) = (looked_at().filter(is_tip).count(), looked_at().count());
        (tips > 0).then(|| {
            let strands = counted(looked_at, "strand", "strands");
            let all = if looked_at == ends.len() { "" } else { " that were looked at" };
            format!(
                "{tips} of {strands}{all} begin farther from all obstacles than they end: if they were \
                 written tip first, root_end = \"nearest\" holds the nearer ends"
            )
        })
    });
    (held, warning.flatten())
}

/// The strands of a body.
struct Strands {
    first: u32,
    neighbors: Vec<Vec<u32>>,
}

impl Strands {
    fn new(body: &WorldBody) -> Self {
        let first = body.vertices.start;
        let mut neighbors = vec![Vec::new(); body.vertices.len()];
        for &[a, b] in &body.strands {
            neighbors[(a - first) as usize].push(b);
            neighbors[(b - first) as usize].push(a);
        }
        Self { first, neighbors }
    }

    /// Both ends of each strand: the vertex that comes first in the mesh, and the farthest from it along the
    /// strand.
    fn ends(&self) -> Vec<[u32; 2]> {
        let mut seen = vec![false; self.neighbors.len()];
        let mut ends = Vec::new();
        for root in (self.first..).take(self.neighbors.len()) {
            if !seen[(root - self.first) as usize] {
                let strand = self.within(root, usize::MAX);
                strand.iter().for_each(|v| seen[(v - self.first) as usize] = true);
                ends.push([root, strand.last().copied().unwrap_or(root)]);
            }
        }
        ends
    }

    /// The vertices within `count - 1` edges of a vertex, in the order of their distance along the strand.
    fn within(&self, root: u32, count: usize) -> Vec<u32> {
        let mut found = Vec::new();
        let (mut seen, mut ring) = (HashSet::from([root]), vec![root]);
        for _ in 0..count {
            let next = ring.iter().flat_map(|v| &self.neighbors[(v - self.first) as usize]).copied();
            let next = next.filter(|w| seen.insert(*w)).collect();
            found.append(&mut ring);
            ring = next;
            if ring.is_empty() {
                break;
            }
        }
        found
    }
}
