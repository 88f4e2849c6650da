//! Twin of `shader/sort.wgsl`.

use crate::bound::Bound;
use crate::layout::{Bucket, Control, Row};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

pub fn bound(buffers: Bound<'_>) {
    sort(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &mut buffers.write(2),
        &mut buffers.write(3),
        &buffers.read::<Control>(4)[0],
    );
}

pub fn sort(
    params: Params,
    rows: &[Row],
    buckets: &[Bucket],
    tally: &mut [u32],
    order: &mut [u32],
    control: &Control,
) {
    for (r, row) in rows.iter().enumerate().take(control.rows.min(params.capacity) as usize) {
        let bucket = row.bucket as usize;
        tally[bucket] -= 1;
        order[(buckets[bucket].first + tally[bucket]) as usize] = r as u32;
    }
}
