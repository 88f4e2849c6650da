//! Twin of `shader/list.wgsl`.

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
        &mut buffers.write(2),
        &mut buffers.write(3),
        &buffers.read::<Control>(4)[0],
    );
}

pub fn list(
    params: Params,
    starts: &[u32],
    candidates: &[Candidate],
    rows: &mut [Row],
    pairs: &mut [Candidate],
    control: &Control,
) {
    let [capacity, row_capacity] = [params.capacity, params.row_capacity].map(|count| count as usize);
    for c in 0..capacity.max(row_capacity) {
        if c < capacity && starts[c + 1] > starts[c] {
            let place = starts[c] as usize;
            rows[place].candidate = c as u32;
            pairs[place] = candidates[c];
        }
        if c >= control.rows as usize && c < row_capacity {
            rows[c].candidate = NONE;
        }
    }
}
