//! Twin of `shader/place.wgsl`.

use super::count::{BLOCK, CONTACT_ROWS, rows_of};
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
    let rows = rows_of(params.list, params.rows, control) as usize;
    for row in 0..rows {
        starts[row] = starts[row].saturating_add(blocks[row / BLOCK]);
    }
    if params.list == CONTACT_ROWS {
        starts[rows] = control.rows;
    } else if rows > 0 {
        starts[rows] = control.candidates;
    }
}
