//! Twin of `shader/diagonal.wgsl`.

use crate::bound::Bound;
use crate::linear::{BLOCK_WORDS, SLICE};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
}

pub fn bound(buffers: Bound<'_>) {
    diagonal(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2));
}

pub fn diagonal(params: Params, slices: &[[u32; 4]], words: &[u32], diagonal: &mut [f32]) {
    let number = |at: usize| f32::from_bits(words[at]);
    for i in 0..params.nodes as usize {
        let [first, blocks, scalars, _] = slices[i / SLICE];
        let mut at = first as usize + i % SLICE;
        let mut sum = [0.0f32; 9];
        for k in 0..blocks {
            let sign = if k == 0 { 1.0 } else { -1.0 };
            for (c, sum) in sum.iter_mut().enumerate() {
                *sum += sign * number(at + (1 + c) * SLICE);
            }
            at += BLOCK_WORDS * SLICE;
        }
        let mut scalar = 0.0;
        for _ in 0..scalars {
            scalar += number(at + SLICE);
            at += 2 * SLICE;
        }
        diagonal[6 * i..6 * i + 6].copy_from_slice(&[
            sum[0] - scalar,
            0.5 * (sum[1] + sum[3]),
            0.5 * (sum[2] + sum[6]),
            sum[4] - scalar,
            0.5 * (sum[5] + sum[7]),
            sum[8] - scalar,
        ]);
    }
}
