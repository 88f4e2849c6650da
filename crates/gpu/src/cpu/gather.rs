//! Twin of `shader/gather.wgsl`.

use super::count::BLOCK;
use crate::bound::Bound;
use crate::layout::{Candidate, Control};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
    pub stride: u32,
    pub most: u32,
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    gather(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &buffers.read::<Control>(4)[0],
    );
}

pub fn gather(
    params: Params,
    partners: &[u32],
    starts: &[u32],
    blocks: &[u32],
    candidates: &mut [Candidate],
    control: &Control,
) {
    if control.changed == 0 {
        return;
    }
    for row in 0..params.rows as usize {
        let words = row * params.stride as usize;
        let count = partners[words].min(params.most) as usize;
        let first = (blocks[row / BLOCK] + starts[row]) as usize;
        let room = (params.capacity as usize).saturating_sub(first);
        for k in 0..count.min(room) {
            candidates[first + k] = Candidate { kind_and_a: partners[words + 1], b: partners[words + 2 + k] };
        }
    }
}
