//! Twin of `shader/factor.wgsl`.

use super::slack::MOST_BLOCKS;
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
}

/// Largest growth of the multipliers in a call.
pub const MOST_GROWTH: f32 = 1e3;

const LEAST: f32 = 0.3;
const MOST: f32 = 2.0;
const LARGE: f32 = 1e6;

pub fn bound(buffers: Bound<'_>) {
    factor(buffers.params(), &buffers.read(0), &mut buffers.write(1));
}

pub fn factor(params: Params, sums: &[[f32; 2]], factor: &mut [f32]) {
    let mut halves = [[0.0f32; 2]; MOST_BLOCKS];
    halves[..params.blocks as usize].copy_from_slice(&sums[..params.blocks as usize]);
    let mut reach = MOST_BLOCKS / 2;
    while reach > 0 {
        for k in 0..reach {
            let [slack, energy] = halves[k + reach];
            halves[k] = [halves[k][0] + slack, halves[k][1] + energy];
        }
        reach /= 2;
    }
    let [slack, energy] = halves[0];
    let mut best = 1.0;
    if energy > 0.0 {
        if slack.abs() < LARGE * energy {
            best = 1.0 - slack / energy;
        } else if slack > 0.0 {
            best = LEAST;
        } else {
            best = MOST;
        }
    }
    let most = MOST.min(factor[1]).max(1.0);
    let s = best.max(LEAST).min(most);
    factor[0] = s;
    factor[1] /= s;
}
