//! Twin of `shader/enlist.wgsl`.

use super::contact::{contact_of, place_of};
use crate::bound::Bound;
use crate::layout::{Candidate, Control, PairState, Separation};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub mask: u32,
}

const NOT_PRESSING: u32 = 0x8000_0000;

pub fn bound(buffers: Bound<'_>) {
    enlist(
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

pub fn enlist(
    params: Params,
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    candidates: &[Candidate],
    separations: &[Separation],
    states: &[PairState],
    starts: &[u32],
    table: &mut [u32],
    control: &Control,
) {
    let count = control.candidates.min(params.capacity) as usize;
    for c in (0..count).filter(|c| starts[*c] != 0) {
        let contact = contact_of(candidates[c], &separations[c], edges, triangles);
        if contact.is_shared {
            let number = if states[c].multiplier > 0.0 { c as u32 } else { c as u32 | NOT_PRESSING };
            let entry = &mut table[place_of(&contact, params.mask)];
            *entry = number.min(*entry);
        }
    }
}
