//! Twin of `shader/inherit.wgsl`.

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
    inherit(
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

pub fn inherit(
    params: Params,
    starts: &[u32],
    candidates: &[Candidate],
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
        let old = old_rows[row];
        let old = old.first as usize..(old.first + old.count) as usize;
        for c in starts[row].min(params.capacity)..starts[row + 1].min(params.capacity) {
            let element = candidates[c as usize].b;
            let found = old.clone().find(|&place| old_elements[place] == element);
            states[c as usize] = found.map_or(PairState::NEW, |place| old_states[place]);
        }
    }
}
