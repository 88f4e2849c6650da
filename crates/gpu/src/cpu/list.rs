//! Twin of `shader/list.wgsl`.

use super::pair::pair_of;
use crate::bound::Bound;
use crate::layout::{Candidate, Control, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
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
    edges: &[[u32; 2]],
    triangles: &[[u32; 4]],
    starts: &[u32],
    candidates: &[Candidate],
    rows: &mut [Row],
    pairs: &mut [Candidate],
    control: &Control,
) {
    for c in 0..control.candidates.min(params.capacity) as usize {
        if starts[c + 1] > starts[c] {
            let place = starts[c] as usize;
            rows[place].vertices = pair_of(candidates[c], edges, triangles).vertices;
            rows[place].candidate = c as u32;
            pairs[place] = candidates[c];
        }
    }
}
