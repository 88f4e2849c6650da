//! Twin of `shader/balance.wgsl`.

use super::{added, dot};
use crate::bound::Bound;
use crate::layout::{Block, BlockSum, Control};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
}

pub fn bound(buffers: Bound<'_>) {
    balance(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write::<Control>(2)[0]);
}

pub fn balance(params: Params, blocks: &[Block], sums: &[BlockSum], control: &mut Control) {
    let blocks = &blocks[..params.blocks as usize];
    for first in 0..blocks.len() {
        let body = blocks[first].body;
        if first > 0 && blocks[first - 1].body == body {
            continue;
        }
        let mut sum = sums[first];
        for k in (first + 1..blocks.len()).take_while(|k| blocks[*k].body == body) {
            sum.residual = added(sum.residual, sums[k].residual);
            sum.mass += sums[k].mass;
            sum.lengths += sums[k].lengths;
        }
        if sum.mass > 0.0 {
            let net = dot(sum.residual, sum.residual).sqrt() / sum.mass;
            control.net_residual = control.net_residual.max(net.to_bits());
            control.mean_residual = control.mean_residual.max((sum.lengths / sum.mass).to_bits());
        }
    }
}
