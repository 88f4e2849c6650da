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
        let Ok(place) = carried.binary_search_by_key(&pair, |entry| entry.candidate) else { continue };
        let CarriedState { friction, multiplier, .. } = carried[place];
        let swapped = pair != candidates[c];
        states[c].friction = if swapped { friction.map(|f| -f) } else { friction };
        states[c].multiplier = multiplier;
    }
}
