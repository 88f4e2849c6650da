//! Limits on the lengths of edges, colored on the host: edges of one color share no vertex that moves.

use crate::grid::Grid;
use crate::layout::EdgeLimit;
use bowknot_geometry::Point;
use std::ops::Range;

/// Smallest ratio of an edge's limit to its length at the start of a call: an edge that starts too long is shortened a
/// little in each call.
const START_SHARE: f64 = 0.97;

/// The limited edges in the order of their colors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    /// Vertices of each edge, and its largest length [m].
    edges: Vec<([u32; 2], f64)>,
    /// Where each color starts, and the end.
    starts: Vec<usize>,
}

impl Edges {
    /// Those of `edges` that have a finite limit [m] and a vertex that moves.
    pub fn new(edges: &[[u32; 2]], limits: &[f64], moves: impl Fn(u32) -> bool) -> Self {
        let limited = edges.iter().zip(limits).filter(|(_, limit)| limit.is_finite());
        let mut free: Vec<([u32; 2], f64)> = limited.map(|(edge, limit)| (*edge, *limit)).collect();
        free.retain(|(edge, _)| edge.iter().any(|&v| moves(v)));
        let (mut sorted, mut starts) = (Vec::with_capacity(free.len()), vec![0]);
        // Round by round: all edges whose vertices are not yet taken in it make the next color.
        let mut taken = std::collections::HashMap::new();
        while !free.is_empty() {
            let color = starts.len();
            free.retain(|&(edge, limit)| {
                let is_taken = |v: &&u32| moves(**v) && taken.get(*v) == Some(&color);
                if edge.iter().any(|v| is_taken(&v)) {
                    return true;
                }
                edge.iter().filter(|v| moves(**v)).for_each(|&v| {
                    taken.insert(v, color);
                });
                sorted.push((edge, limit));
                false
            });
            starts.push(sorted.len());
        }
        Self { edges: sorted, starts }
    }

    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// The edges of each color.
    pub fn colors(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.starts.windows(2).map(|two| two[0]..two[1])
    }

    /// The limits of a call that starts at `positions` [m], without multipliers.
    pub fn limits(&self, positions: &[Point], grid: &Grid) -> Vec<EdgeLimit> {
        let limit = |&([a, b], limit): &([u32; 2], f64)| {
            let start = (positions[a as usize] - positions[b as usize]).norm();
            EdgeLimit { a, b, limit: grid.length(limit.max(START_SHARE * start)), ..EdgeLimit::default() }
        };
        self.edges.iter().map(limit).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_a_color_share_no_vertex_that_moves() {
        // A fan around vertex 0, which does not move, and a chain.
        let edges: Vec<[u32; 2]> = (1..20).map(|v| [0, v]).chain((1..19).map(|v| [v, v + 1])).collect();
        let mut limits = vec![1.0; edges.len()];
        limits[3] = f64::INFINITY;
        let colored = Edges::new(&edges, &limits, |v| v > 0);
        assert_eq!(colored.len(), edges.len() - 1);
        for color in colored.colors() {
            let mut seen: Vec<u32> =
                colored.edges[color].iter().flat_map(|(edge, _)| *edge).filter(|v| *v > 0).collect();
            let count = seen.len();
            seen.sort_unstable();
            seen.dedup();
            assert_eq!(seen.len(), count);
        }
        assert!(colored.colors().count() <= 4, "{:?}", colored.starts);
    }
}
