//! Twin of `shader/list.wgsl`.

use super::count::BLOCK;
use crate::bound::Bound;
use crate::layout::{Control, NONE, Row};
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
        &mut buffers.write(3),
        &buffers.read::<Control>(4)[0],
    );
}

pub fn list(
    params: Params,
    picked: &[u32],
    starts: &[u32],
    blocks: &[u32],
    rows: &mut [Row],
    control: &Control,
) {
    for c in 0..params.capacity as usize {
        if picked[c] != 0 {
            rows[(blocks[c / BLOCK] + starts[c]) as usize].candidate = c as u32;
        }
        if c >= control.rows as usize {
            rows[c].candidate = NONE;
        }
    }
}
