//! Twin of `shader/slip.wgsl`.

use super::{added, difference, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, PairFriction, PairState, Row, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub pair_frictions: u32,
    pub first_half_space: u32,
}

pub fn bound(buffers: Bound<'_>) {
    slip(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &buffers.read(5),
        &mut buffers.write(6),
        &buffers.read::<Control>(7)[0],
    );
}

fn across(normal: [f32; 3], v: [f32; 3]) -> [f32; 3] {
    subtracted(v, scaled(normal, dot(normal, v)))
}

fn friction_of(pair_frictions: &[PairFriction], one: &Vertex, other: &Vertex) -> f32 {
    let (a, b) = (one.body.min(other.body), one.body.max(other.body));
    let (mut low, mut high) = (0, pair_frictions.len());
    while low < high {
        let middle = (low + high) / 2;
        let pair = pair_frictions[middle];
        if pair.a == a && pair.b == b {
            return pair.coefficient;
        }
        if pair.a < a || (pair.a == a && pair.b < b) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    one.root_of_friction * other.root_of_friction
}

pub fn slip(
    params: Params,
    positions: &[[i32; 4]],
    slip_start: &[[i32; 4]],
    vertices: &[Vertex],
    pair_frictions: &[PairFriction],
    candidates: &[Candidate],
    states: &[PairState],
    rows: &mut [Row],
    control: &Control,
) {
    for row in &mut rows[..control.rows.min(params.capacity) as usize] {
        let candidate = candidates[row.candidate as usize];
        let kind = candidate.kind();
        let other = if kind == Kind::VertexHalfSpace as u32 {
            params.first_half_space + candidate.b
        } else if kind == Kind::EdgeEdge as u32 {
            row.vertices[2]
        } else {
            row.vertices[1]
        };
        let [one, other] = [row.vertices[0], other].map(|v| vertices[v as usize]);
        let mut slip = [0.0; 3];
        for (v, weight) in row.vertices.map(|v| v as usize).into_iter().zip(row.weights) {
            slip = added(slip, scaled(difference(positions[v], slip_start[v]), weight));
        }
        row.coefficient = friction_of(&pair_frictions[..params.pair_frictions as usize], &one, &other);
        row.slip = across(row.normal, slip);
        row.friction = across(row.normal, states[row.candidate as usize].friction);
    }
}
