//! Twin of `shader/summarize.wgsl`.

use super::sum::sum_of_parts;
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub count: u32,
}

pub fn bound(buffers: Bound<'_>) {
    summarize(buffers.params(), &buffers.read(0), &mut buffers.write(1));
}

pub fn summarize(params: Params, sums: &[f32], summary: &mut [f32]) {
    let column = |k: usize| sums.chunks_exact(8).take(params.count as usize).map(move |part| part[k]);
    summary[0] = sum_of_parts(&column(0).collect::<Vec<_>>());
    for k in 1..5 {
        summary[k] = column(k).fold(0.0, f32::max);
    }
}
