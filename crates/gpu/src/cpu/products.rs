//! Twin of `shader/products.wgsl`.

use super::dot;
use super::newton::{sum_segments, xyz};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
}

pub fn bound(buffers: Bound<'_>) {
    products(buffers.params(), &buffers.read(0), &buffers.read(1), &buffers.read(2), &mut buffers.write(3));
}

pub fn products(
    params: Params,
    blocks: &[u32],
    solution: &[[f32; 4]],
    direction: &[[f32; 4]],
    totals: &mut [[f32; 4]],
) {
    let nodes = params.nodes as usize;
    let product = |i: usize| {
        let r = xyz(solution[nodes + i]);
        [dot(r, xyz(direction[i])), dot(r, r), 0.0, 0.0]
    };
    sum_segments(&blocks[..nodes], product, totals);
}
