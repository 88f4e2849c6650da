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

/// Threads that share the blocks of a body.
const THREADS: usize = 64;

pub fn balance(params: Params, blocks: &[Block], sums: &[BlockSum], control: &mut Control) {
    let blocks = &blocks[..params.blocks as usize];
    for first in 0..blocks.len() {
        let body = blocks[first].body;
        if first > 0 && blocks[first - 1].body == body {
            continue;
        }
        let mut parts = [BlockSum::default(); THREADS];
        for (k, _) in blocks[first..].iter().enumerate().take_while(|(_, block)| block.body == body) {
            parts[k % THREADS] = joined(parts[k % THREADS], sums[first + k]);
        }
        let mut reach = THREADS / 2;
        while reach > 0 {
            (0..reach).for_each(|k| parts[k] = joined(parts[k], parts[k + reach]));
            reach /= 2;
        }
        let sum = parts[0];
        if sum.mass > 0.0 {
            let net = dot(sum.residual, sum.residual).sqrt() / sum.mass;
            control.net_residual = control.net_residual.max(net.to_bits());
            control.mean_residual = control.mean_residual.max((sum.lengths / sum.mass).to_bits());
        }
    }
}

fn joined(a: BlockSum, b: BlockSum) -> BlockSum {
    BlockSum {
        residual: added(a.residual, b.residual),
        mass: a.mass + b.mass,
        lengths: a.lengths + b.lengths,
        ..a
    }
}
