//! Twin of `shader/resume.wgsl`.

use crate::bound::Bound;
use crate::layout::{Candidate, CarriedState, Control, PairState};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub carried: u32,
}

pub fn bound(buffers: Bound<'_>) {
    resume(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &buffers.read::<Control>(3)[0],
    );
}

fn place_of(carried: &[CarriedState], pair: Candidate) -> Option<usize> {
    let (mut low, mut high) = (0, carried.len());
    while low < high {
        let middle = (low + high) / 2;
        let found = carried[middle].candidate;
        if found == pair {
            return Some(middle);
        }
        if found < pair {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    None
}

pub fn resume(
    params: Params,
    carried: &[CarriedState],
    candidates: &[Candidate],
    states: &mut [PairState],
    control: &Control,
) {
    let carried = &carried[..params.carried as usize];
    for c in 0..control.candidates.min(params.capacity) as usize {
        let pair = candidates[c].ordered();
        let Some(place) = place_of(carried, pair) else { continue };
        let CarriedState { friction, multiplier, .. } = carried[place];
        let swapped = pair != candidates[c];
        states[c].friction = if swapped { friction.map(|f| -f) } else { friction };
        states[c].multiplier = multiplier;
    }
}
