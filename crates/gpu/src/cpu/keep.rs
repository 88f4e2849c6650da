//! Twin of `shader/keep.wgsl`.

use crate::bound::Bound;
use crate::layout::{Candidate, Control, OldRow, PairState};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    keep(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &mut buffers.write(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &buffers.read::<Control>(6)[0],
    );
}

pub fn keep(
    params: Params,
    starts: &[u32],
    candidates: &[Candidate],
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
        let first = starts[row].min(total);
        let count = starts[row + 1].min(total) - first;
        old_rows[row] = OldRow { first, count };
        for k in 0..count as usize {
            let place = first as usize + k;
            old_elements[place] = candidates[place].b;
            old_states[place] = states[place];
        }
    }
}
