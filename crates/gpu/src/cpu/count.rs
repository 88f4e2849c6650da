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

/// Rows that have numbers of entries, of at most so many; none if the list stays as it is.
pub fn rows_of(list: u32, most: u32, control: &Control) -> u32 {
    match list {
        CANDIDATES if control.changed == 0 => 0,
        CANDIDATES => most,
        _ => control.candidates.min(most),
    }
}

pub fn count(params: Params, starts: &mut [u32], blocks: &mut [u32], control: &Control) {
    let rows = rows_of(params.list, params.rows, control) as usize;
    for (block, starts) in starts[..rows].chunks_mut(BLOCK).enumerate() {
        let mut sum = 0u32;
        for start in starts {
            let count = std::mem::replace(start, sum);
            sum = sum.saturating_add(count);
        }
        blocks[block] = sum;
    }
}
