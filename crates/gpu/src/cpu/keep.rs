//! Twin of `shader/keep.wgsl`.

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
    keep(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.read::<Control>(7)[0],
    );
}

pub fn keep(
    params: Params,
    partners: &[u32],
    starts: &[u32],
    blocks: &[u32],
    states: &[PairState],
    old_rows: &mut [OldRow],
    old_elements: &mut [u32],
    old_states: &mut [PairState],
    control: &Control,
) {
    if control.changed == 0 {
        return;
    }
    let total = control.candidates.min(params.capacity);
    for row in 0..params.rows as usize {
        let words = row * params.stride as usize;
        let first = (blocks[row / BLOCK] + starts[row]).min(total);
        let count = partners[words].min(params.most).min(total - first);
        old_rows[row] = OldRow { first, count };
        for k in 0..count as usize {
            let place = first as usize + k;
            old_elements[place] = partners[words + 2 + k];
            old_states[place] = states[place];
        }
    }
}
