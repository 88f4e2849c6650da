//! Twin of `shader/count.wgsl`.

use crate::bound::Bound;
use crate::layout::Control;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
    pub list: u32,
}

/// Values of [`Params::list`], and of those of `total` and `place`.
pub const CANDIDATES: u32 = 0;
pub const CONTACT_ROWS: u32 = 1;

/// Rows of a block: the threads of a workgroup.
pub const BLOCK: usize = 256;

pub fn bound(buffers: Bound<'_>) {
    count(buffers.params(), &mut buffers.write(0), &mut buffers.write(1), &buffers.read::<Control>(2)[0]);
}

/// Whether a list stays as it is.
pub fn is_unchanged(list: u32, control: &Control) -> bool {
    list == CANDIDATES && control.changed == 0
}

pub fn count(params: Params, starts: &mut [u32], blocks: &mut [u32], control: &Control) {
    if is_unchanged(params.list, control) {
        return;
    }
    for (block, starts) in starts[..params.rows as usize].chunks_mut(BLOCK).enumerate() {
        let mut sum = 0u32;
        for start in starts {
            let count = std::mem::replace(start, sum);
            sum = sum.saturating_add(count);
        }
        blocks[block] = sum;
    }
}
