//! Twin of `shader/slip.wgsl`.

use super::{added, difference, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::layout::{Candidate, Kind, NONE, PairState, Plane, Row, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
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
    );
}

fn across(normal: [f32; 3], v: [f32; 3]) -> [f32; 3] {
    subtracted(v, scaled(normal, dot(normal, v)))
}

pub fn slip(
    params: Params,
    positions: &[[i32; 4]],
    slip_start: &[[i32; 4]],
    vertices: &[Vertex],
    planes: &[Plane],
    candidates: &[Candidate],
    states: &[PairState],
    rows: &mut [Row],
) {
    let root = |v: u32| vertices[v as usize].root_of_friction;
    for row in rows[..params.capacity as usize].iter_mut().filter(|row| row.candidate != NONE) {
        let candidate = candidates[row.candidate as usize];
        let kind = candidate.kind();
        let other = if kind == Kind::VertexHalfSpace as u32 {
            planes[candidate.b as usize].root_of_friction
        } else if kind == Kind::EdgeEdge as u32 {
            root(row.vertices[2])
        } else {
            root(row.vertices[1])
        };
        let mut slip = [0.0; 3];
        for (v, weight) in row.vertices.map(|v| v as usize).into_iter().zip(row.weights) {
            slip = added(slip, scaled(difference(positions[v], slip_start[v]), weight));
        }
        row.coefficient = root(row.vertices[0]) * other;
        row.slip = across(row.normal, slip);
        row.friction = across(row.normal, states[row.candidate as usize].friction);
    }
}
