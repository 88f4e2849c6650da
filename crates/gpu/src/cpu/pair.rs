//! Twin of `shader/shared/pair.wgsl`.

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

pub fn pair_of(candidate: Candidate, edges: &[[u32; 2]], triangles: &[[u32; 4]]) -> Pair {
    let (kind, a, b) = (candidate.kind(), candidate.a(), candidate.b);
    match kind {
        VERTEX_VERTEX => Pair { kind, count: 2, side_a: 1, vertices: [a, b, a, a] },
        VERTEX_EDGE => {
            let edge = edges[b as usize];
            Pair { kind, count: 3, side_a: 1, vertices: [a, edge[0], edge[1], a] }
        }
        VERTEX_TRIANGLE => {
            let triangle = triangles[b as usize];
            Pair { kind, count: 4, side_a: 1, vertices: [a, triangle[0], triangle[1], triangle[2]] }
        }
        EDGE_EDGE => {
            let (first, second) = (edges[a as usize], edges[b as usize]);
            Pair { kind, count: 4, side_a: 2, vertices: [first[0], first[1], second[0], second[1]] }
        }
        _ => Pair { kind, count: 1, side_a: 1, vertices: [a; 4] },
    }
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
