//! Twin of `shader/near.wgsl`.

use super::pair::pair_of;
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Kind, Separation, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

const LARGER: f32 = 1.000_001;

pub fn bound(buffers: Bound<'_>) {
    near(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
        &buffers.read::<Control>(6)[0],
    );
}

pub fn near(
    params: Params,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    vertices: &[Vertex],
    candidates: &[Candidate],
    separations: &[Separation],
    starts: &mut [u32],
    control: &Control,
) {
    let count = control.candidates.min(params.capacity) as usize;
    let is_near = |c: usize| {
        let pair = pair_of(candidates[c], edges, triangles);
        let is_half_space = pair.kind == Kind::VertexHalfSpace as u32;
        let other = if is_half_space { pair.vertices[0] } else { pair.vertices[pair.side_a] };
        let range = vertices[pair.vertices[0] as usize].margin + vertices[other as usize].margin;
        separations[c].width <= LARGER * range
    };
    for c in 0..count {
        starts[c] = u32::from(is_near(c));
    }
}
