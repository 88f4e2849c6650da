//! Twin of `shader/shared/pair.wgsl` and `weights.wgsl`.

use crate::layout::{Candidate, Kind, Separation};

#[derive(Clone, Copy, Debug)]
pub struct Pair {
    pub kind: u32,
    pub count: usize,
    pub side_a: usize,
    pub vertices: [u32; 4],
}

const VERTEX_VERTEX: u32 = Kind::VertexVertex as u32;
const VERTEX_EDGE: u32 = Kind::VertexEdge as u32;
const VERTEX_TRIANGLE: u32 = Kind::VertexTriangle as u32;
const EDGE_EDGE: u32 = Kind::EdgeEdge as u32;

/// A pair of that kind, of which the vertices are known.
pub fn pair_with(kind: u32, vertices: [u32; 4]) -> Pair {
    let (count, side_a) = match kind {
        VERTEX_VERTEX => (2, 1),
        VERTEX_EDGE => (3, 1),
        VERTEX_TRIANGLE => (4, 1),
        EDGE_EDGE => (4, 2),
        _ => (1, 1),
    };
    Pair { kind, count, side_a, vertices }
}

pub fn pair_of(candidate: Candidate, edges: &[[u32; 2]], triangles: &[[u32; 4]]) -> Pair {
    let (kind, a, b) = (candidate.kind(), candidate.a(), candidate.b);
    let vertices = match kind {
        VERTEX_VERTEX => [a, b, a, a],
        VERTEX_EDGE => {
            let [c, d] = edges[b as usize];
            [a, c, d, a]
        }
        VERTEX_TRIANGLE => {
            let [c, d, e, _] = triangles[b as usize];
            [a, c, d, e]
        }
        EDGE_EDGE => {
            let ([c, d], [e, f]) = (edges[a as usize], edges[b as usize]);
            [c, d, e, f]
        }
        _ => [a; 4],
    };
    pair_with(kind, vertices)
}

pub fn signed_weights(pair: &Pair, separation: &Separation) -> [f32; 4] {
    let [s, t] = separation.weights;
    match pair.kind {
        VERTEX_VERTEX => [1.0, -1.0, 0.0, 0.0],
        VERTEX_EDGE => [1.0, s - 1.0, -s, 0.0],
        VERTEX_TRIANGLE => [1.0, s + t - 1.0, -s, -t],
        EDGE_EDGE => [1.0 - s, s, t - 1.0, -t],
        _ => [1.0, 0.0, 0.0, 0.0],
    }
}
