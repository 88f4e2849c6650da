//! Twin of `shader/start_buckets.wgsl`.

use crate::bound::Bound;
use crate::layout::Bucket;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub buckets: u32,
}

pub fn bound(buffers: Bound<'_>) {
    start_buckets(buffers.params(), &buffers.read(0), &mut buffers.write(1));
}

pub fn start_buckets(params: Params, tally: &[u32], buckets: &mut [Bucket]) {
    let mut total = 0;
    for (bucket, count) in buckets.iter_mut().zip(tally).take(params.buckets as usize) {
        *bucket = Bucket { first: total, end: total + count, colors: 0, most: 0 };
        total += count;
    }
}
