//! Twin of `shader/list_near.wgsl`.

use crate::bound::Bound;
use crate::layout::{Candidate, Control};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub near_capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    list_near(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &buffers.read::<Control>(3)[0],
    );
}

pub fn list_near(
    params: Params,
    starts: &[u32],
    candidates: &[Candidate],
    near: &mut [Candidate],
    control: &Control,
) {
    for c in 0..control.candidates.min(params.capacity) as usize {
        let place = starts[c];
        if starts[c + 1] > place && place < params.near_capacity {
            near[place as usize] = candidates[c];
        }
    }
}
