//! One number per element for the test of candidate pairs, such as how far its vertices are from the centers
//! of their trust regions. An element is a side of many candidates: with a number per element, testing a
//! candidate reads two numbers and its 8 bytes, and its vertices are not looked up.

use bowknot_geometry::{PairKind, Topology};
use bowknot_proximity::{CandidateList, Candidates};
use rayon::prelude::*;
use std::ops::Range;

/// Elements that one task computes, or whose candidates it tests.
const ELEMENTS: usize = 1024;

/// A number [m] for each element that is a side of candidates.
#[derive(Debug, Default)]
pub(super) struct Sides {
    vertices: Vec<f32>,
    edges: Vec<f32>,
    triangles: Vec<f32>,
}

impl Sides {
    /// Computes the numbers: `of(vertices)` is that of an element with these vertices. Elements of kinds
    /// without candidates are left out.
    pub fn fill(
        &mut self,
        topology: &Topology,
        candidates: &CandidateList,
        of: impl Fn(&[u32]) -> f32 + Sync,
    ) {
        let [mut vertices, mut edges, mut triangles] = [false; 3];
        for kind in PairKind::ALL {
            if candidates.of(kind).is_some_and(|list| !list.is_empty()) {
                vertices |= kind != PairKind::EdgeEdge;
                edges |= matches!(kind, PairKind::EdgeEdge | PairKind::VertexEdge);
                triangles |= kind == PairKind::VertexTriangle;
            }
        }
        let count = |needed: bool, count: usize| if needed { count } else { 0 };
        self.vertices.resize(count(vertices, topology.vertex_count), 0.0);
        self.edges.resize(count(edges, topology.edges.len()), 0.0);
        self.triangles.resize(count(triangles, topology.triangles.len()), 0.0);
        let values = self.vertices.par_iter_mut().enumerate().with_min_len(ELEMENTS);
        values.for_each(|(v, value)| *value = of(&[v as u32]));
        let values = self.edges.par_iter_mut().zip(&topology.edges).with_min_len(ELEMENTS);
        values.for_each(|(value, edge)| *value = of(edge));
        let values = self.triangles.par_iter_mut().zip(&topology.triangles).with_min_len(ELEMENTS);
        values.for_each(|(value, triangle)| *value = of(triangle));
    }

    /// The numbers of both sides of a kind of pair.
    pub fn of(&self, kind: PairKind) -> [&[f32]; 2] {
        match kind {
            PairKind::VertexVertex | PairKind::VertexHalfSpace => [&self.vertices; 2],
            PairKind::VertexEdge => [&self.vertices, &self.edges],
            PairKind::VertexTriangle => [&self.vertices, &self.triangles],
            PairKind::EdgeEdge => [&self.edges; 2],
        }
    }
}

/// Number of ranges of elements of side *a* that tasks test.
pub(super) fn range_count(list: &Candidates) -> usize {
    list.elements().len().div_ceil(ELEMENTS)
}

/// One of these ranges; none if it has no candidates.
pub(super) fn range_of(list: &Candidates, index: usize) -> Option<Range<usize>> {
    let elements = list.elements().len();
    let range = index * ELEMENTS..((index + 1) * ELEMENTS).min(elements);
    (list.count(range.clone()) > 0).then_some(range)
}
