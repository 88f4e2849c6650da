//! Twin of `shader/list.wgsl`.

use super::count::BLOCK;
use crate::bound::Bound;
use crate::layout::{Candidate, Control, NONE, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub row_capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    list(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &mut buffers.write(4),
        &mut buffers.write(5),
        &buffers.read::<Control>(6)[0],
    );
}

pub fn list(
    params: Params,
    picked: &[u32],
    starts: &[u32],
    blocks: &[u32],
    candidates: &[Candidate],
    rows: &mut [Row],
    pairs: &mut [Candidate],
    control: &Control,
) {
    let [capacity, row_capacity] = [params.capacity, params.row_capacity].map(|count| count as usize);
    for c in 0..capacity.max(row_capacity) {
        if c < capacity && picked[c] != 0 {
            let place = (blocks[c / BLOCK] + starts[c]) as usize;
            rows[place].candidate = c as u32;
            pairs[place] = candidates[c];
        }
        if c >= control.rows as usize && c < row_capacity {
            rows[c].candidate = NONE;
        }
    }
}
