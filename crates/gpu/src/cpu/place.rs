//! Twin of `shader/place.wgsl`.

use super::count::{BLOCK, CANDIDATES, is_unchanged};
use crate::bound::Bound;
use crate::layout::Control;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
    pub list: u32,
}

pub fn bound(buffers: Bound<'_>) {
    place(buffers.params(), &buffers.read(0), &mut buffers.write(1), &buffers.read::<Control>(2)[0]);
}

pub fn place(params: Params, blocks: &[u32], starts: &mut [u32], control: &Control) {
    if is_unchanged(params.list, control) {
        return;
    }
    for row in 0..params.rows as usize {
        starts[row] = starts[row].saturating_add(blocks[row / BLOCK]);
    }
    starts[params.rows as usize] = if params.list == CANDIDATES { control.candidates } else { control.rows };
}
