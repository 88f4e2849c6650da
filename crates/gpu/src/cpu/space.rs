//! Twin of `shader/space.wgsl`.

use super::closest::{edge_edge, vertex_edge, vertex_triangle};
use super::pair::{Pair, pair_of};
use super::{difference, dot};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, PairState, Separation, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub after_search: u32,
    pub min_separation: f32,
    pub growth: f32,
    pub range: f32,
    pub first_half_space: u32,
    pub known: f32,
    pub guarded: f32,
    pub guarded_floor: f32,
}

const MIN_SEPARATION_SHARE: f32 = 0.1;
const MIN_SEPARATION_MARGIN: f32 = 1.5;

pub fn bound(buffers: Bound<'_>) {
    space(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.read::<Control>(7)[0],
    );
}

pub fn space(
    params: Params,
    rest: &[[i32; 4]],
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    vertices: &[Vertex],
    candidates: &[Candidate],
    separations: &mut [Separation],
    states: &mut [PairState],
    control: &Control,
) {
    if params.after_search != 0 && control.changed == 0 {
        return;
    }
    for c in 0..control.candidates.min(params.capacity) as usize {
        if states[c].desired < 0.0 {
            let pair = pair_of(candidates[c], edges, triangles);
            let first = first_state(&params, candidates[c], &pair, &separations[c], rest, vertices);
            let PairState { friction, multiplier, .. } = states[c];
            states[c] = PairState { friction, multiplier, ..first };
        }
        separations[c].min_separation = states[c].min_separation;
        separations[c].wanted = states[c].desired;
    }
}

fn rest_distance(pair: &Pair, rest: &[[i32; 4]]) -> f32 {
    let x = pair.vertices.map(|v| rest[v as usize]);
    let [a, b, c] = [1, 2, 3].map(|k| difference(x[k], x[0]));
    let offset = if pair.kind == Kind::VertexVertex as u32 {
        a
    } else if pair.kind == Kind::VertexEdge as u32 {
        vertex_edge(a, b).offset
    } else if pair.kind == Kind::EdgeEdge as u32 {
        edge_edge(a, b, c).offset
    } else {
        vertex_triangle(a, b, c).offset
    };
    dot(offset, offset).sqrt()
}

fn first_state(
    params: &Params,
    candidate: Candidate,
    pair: &Pair,
    separation: &Separation,
    rest: &[[i32; 4]],
    vertices: &[Vertex],
) -> PairState {
    let a = vertices[pair.vertices[0] as usize];
    let mut delta = a.half_space_delta;
    let mut range = params.range * delta;
    let mut thickness = -1.0;
    if pair.kind == Kind::VertexHalfSpace as u32 {
        let b = vertices[(params.first_half_space + candidate.b) as usize];
        if b.thickness >= 0.0 {
            delta = delta.max(0.5 * (a.delta + MIN_SEPARATION_MARGIN * b.thickness));
            range = params.range * delta;
        }
        if a.thickness.max(b.thickness) >= 0.0 {
            let of_a = if a.thickness >= 0.0 { a.thickness } else { params.min_separation };
            thickness = 0.5 * (of_a + b.thickness.max(0.0));
        }
    } else {
        let b = vertices[pair.vertices[pair.side_a] as usize];
        let component = |side: usize| rest[pair.vertices[side] as usize][3];
        delta = 0.5 * (a.delta + b.delta);
        if a.thickness.max(b.thickness) >= 0.0 {
            let of = |thickness: f32| if thickness >= 0.0 { thickness } else { params.min_separation };
            thickness = 0.5 * (of(a.thickness) + of(b.thickness));
        }
        range = params.range * delta;
        if component(0) == component(pair.side_a) {
            delta = delta.min(0.5 * rest_distance(pair, rest));
        }
    }
    let distance = separation.distance.max(0.0);
    let mut desired = delta.min(distance + params.growth);
    let min_separation = if thickness >= 0.0 {
        thickness.min(delta / MIN_SEPARATION_MARGIN).min(separation.width.max(0.0))
    } else {
        params.min_separation.min(MIN_SEPARATION_SHARE * desired)
    };
    let is_known = pair.vertices.iter().any(|&v| vertices[v as usize].flags & Vertex::KNOWN != 0);
    if is_known && distance < params.known * delta {
        let lowest = min_separation + params.guarded_floor * (delta - min_separation);
        desired = desired.min(lowest.max(params.guarded * distance));
    }
    PairState { desired, min_separation, range, ..PairState::NEW }
}
