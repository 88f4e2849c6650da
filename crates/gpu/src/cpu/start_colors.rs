//! Twin of `shader/start_colors.wgsl`.

use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub colors: u32,
}

pub fn bound(buffers: Bound<'_>) {
    start_colors(buffers.params(), &mut buffers.write(0), &mut buffers.write(1));
}

pub fn start_colors(params: Params, tally: &mut [u32], starts: &mut [u32]) {
    let mut sum = 0;
    for color in 0..params.colors as usize {
        starts[color] = sum;
        sum += tally[color];
        tally[color] = 0;
    }
}
