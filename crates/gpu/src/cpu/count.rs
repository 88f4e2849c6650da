//! Twin of `shader/count.wgsl`.

use crate::bound::Bound;
use crate::layout::Control;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
    pub stride: u32,
    pub most: u32,
}

/// Rows of a block: the threads of a workgroup.
pub const BLOCK: usize = 256;

pub fn bound(buffers: Bound<'_>) {
    count(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write(1),
        &mut buffers.write(2),
        &mut buffers.write::<Control>(3)[0],
    );
}

pub fn count(
    params: Params,
    partners: &[u32],
    starts: &mut [u32],
    blocks: &mut [u32],
    control: &mut Control,
) {
    for block in 0..(params.rows as usize).div_ceil(BLOCK) {
        let mut sum = 0;
        for row in block * BLOCK..((block + 1) * BLOCK).min(params.rows as usize) {
            let found = partners[row * params.stride as usize];
            if control.changed != 0 {
                control.most_partners = control.most_partners.max(found);
                if found > params.most {
                    control.overflow = 1;
                }
            }
            starts[row] = sum;
            sum += found.min(params.most);
        }
        blocks[block] = sum;
    }
}
