//! Twin of `shader/total.wgsl`.

use super::count::{BLOCK, CANDIDATES, rows_of};
use crate::bound::Bound;
use crate::layout::Control;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
    pub capacity: u32,
    pub list: u32,
}

pub fn bound(buffers: Bound<'_>) {
    total(buffers.params(), &mut buffers.write(0), &mut buffers.write::<Control>(1)[0]);
}

pub fn total(params: Params, blocks: &mut [u32], control: &mut Control) {
    let most = BLOCK as u32 * params.blocks;
    let count = rows_of(params.list, most, control).div_ceil(BLOCK as u32);
    if params.list == CANDIDATES && count == 0 {
        return;
    }
    let mut total = 0u32;
    for block in &mut blocks[..count as usize] {
        let count = *block;
        *block = total;
        total = total.saturating_add(count);
    }
    if params.list == CANDIDATES {
        control.candidates = total;
    } else {
        control.rows = total;
    }
    if total > params.capacity {
        control.overflow = 1;
    }
}
