//! Twin of `shader/coarsen.wgsl`.

use super::groups::between;
use super::{added, crossed, scaled};
use crate::assembly::{Frame, Part};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub pairs: u32,
    pub first: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    coarsen(buffers.params(), &buffers.read(0), &buffers.read(1), &buffers.read(2), &mut buffers.write(3));
}

/// Way and ratio of sizes from a group to its part.
fn link(frames: &[Frame], group: u32, part: u32, quantum: f32) -> ([f32; 3], f32) {
    let [parent, child] = [group, part].map(|frame| frames[frame as usize]);
    let way = between(parent.center, child.center, quantum);
    (super::divided(way, parent.size), child.size / parent.size)
}

pub fn coarsen(params: Params, sums: &[[u32; 4]], parts: &[Part], frames: &[Frame], couplings: &mut [f32]) {
    let first = params.first as usize;
    for t in first..first + params.pairs as usize {
        let [start, count, group_a, group_b] = sums[t];
        let mut total = [[0.0; 6]; 6];
        for part in &parts[start as usize..][..count as usize] {
            let (way, ratio) = link(frames, group_a, part.a, params.quantum);
            let (other, other_ratio) = link(frames, group_b, part.b, params.quantum);
            let block = &couplings[36 * part.block as usize..][..36];
            // C M_b, row by row: shifts as they are, spins turn the way and shrink.
            let image: [[f32; 6]; 6] = std::array::from_fn(|r| {
                let row = &block[6 * r..6 * r + 6];
                let force = [row[0], row[1], row[2]];
                let moment = crossed(other, force);
                std::array::from_fn(|k| if k < 3 { force[k] } else { moment[k - 3] + other_ratio * row[k] })
            });
            // M_a^T of that, column by column.
            for k in 0..6 {
                let force = [image[0][k], image[1][k], image[2][k]];
                let spin = scaled([image[3][k], image[4][k], image[5][k]], ratio);
                let moment = added(crossed(way, force), spin);
                for r in 0..3 {
                    total[r][k] += force[r];
                    total[r + 3][k] += moment[r];
                    if part.both == 1 {
                        total[k][r] += force[r];
                        total[k][r + 3] += moment[r];
                    }
                }
            }
        }
        couplings[36 * t..36 * t + 36].copy_from_slice(total.as_flattened());
    }
}
