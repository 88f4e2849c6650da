//! Twin of `shader/inherit.wgsl`.

use super::count::BLOCK;
use crate::bound::Bound;
use crate::layout::{Control, OldRow, PairState};
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
    inherit(
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

pub fn inherit(
    params: Params,
    partners: &[u32],
    starts: &[u32],
    blocks: &[u32],
    old_rows: &[OldRow],
    old_elements: &[u32],
    old_states: &[PairState],
    states: &mut [PairState],
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
        let old = old_rows[row];
        let old = old.first as usize..(old.first + old.count) as usize;
        for k in 0..count.min(room) {
            let element = partners[words + 2 + k];
            let found = old.clone().find(|&place| old_elements[place] == element);
            states[first + k] = found.map_or(PairState::NEW, |place| old_states[place]);
        }
    }
}
