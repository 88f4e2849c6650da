//! Twin of `shader/momenta.wgsl`.

use super::newton::{sum_segments, xyz};
use super::{added, difference, scaled};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub quantum: f32,
}

pub fn bound(buffers: Bound<'_>) {
    let motion = Motion {
        blocks: &buffers.read(0),
        iterate: &buffers.read(1),
        start: &buffers.read(2),
        row_sums: &buffers.read(3),
        step: &buffers.read(4),
    };
    momenta(buffers.params(), &motion, &mut buffers.write(5));
}

pub struct Motion<'a> {
    pub blocks: &'a [u32],
    pub iterate: &'a [[i32; 4]],
    pub start: &'a [[i32; 4]],
    pub row_sums: &'a [f32],
    pub step: &'a [[f32; 4]],
}

pub fn momenta(params: Params, motion: &Motion<'_>, totals: &mut [[f32; 4]]) {
    let force = |i: usize| {
        let way = scaled(difference(motion.iterate[i], motion.start[i]), params.quantum);
        let [x, y, z] = added(way, xyz(motion.step[i]));
        let r = &motion.row_sums[6 * i..6 * i + 6];
        [r[0] * x + r[1] * y + r[2] * z, r[1] * x + r[3] * y + r[4] * z, r[2] * x + r[4] * y + r[5] * z, 0.0]
    };
    sum_segments(&motion.blocks[..params.nodes as usize], force, totals);
}
