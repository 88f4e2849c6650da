// Written from `shader/backward/coarse_factor.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "coarse_factor",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/coarse_factor.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const OBSTACLE: u32 = 1u32;
pub const PRESCRIBED: u32 = 2u32;
pub const SELF_COLLIDES: u32 = 4u32;
pub const KNOWN: u32 = 8u32;
pub const ELEMENT_BITS: u32 = 29u32;
pub const ELEMENT_MASK: u32 = 536870911u32;
pub const VERTEX_VERTEX: u32 = 0u32;
pub const VERTEX_EDGE: u32 = 1u32;
pub const VERTEX_TRIANGLE: u32 = 2u32;
pub const EDGE_EDGE: u32 = 3u32;
pub const VERTEX_HALF_SPACE: u32 = 4u32;
pub const COLORS: u32 = 128u32;
pub const FIXED: u32 = 65535u32;
pub const LEAST: f32 = 0.3f32;
pub const MOST: f32 = 2.0f32;
pub const LARGE: f32 = 1000000.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::coarse_factor::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    sums: &'a [u32],
    factor: &'a mut [u32],
    shared_sums: [[f32; 2]; 256],
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut own_v0: [[f32; 2]; 256] = [[0.0f32; 2]; 256];
    let mut reach_v1: u32 = 128u32;
    let mut best_v2: [f32; 256] = [1.0f32; 256];
    let _e7 = m.params.blocks;
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] < _e7) {
            let _e12 = <[f32; 2]>::load(m.sums, 2 * (([t as u32, 0, 0])[0] as usize));
            own_v0[t] = _e12;
        }
        let _e16 = own_v0[t];
        m.shared_sums[([t as u32, 0, 0])[0] as usize] = _e16;
    }
    'l0: loop {
        'c0: {
            let _e19 = reach_v1;
            if (_e19 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e23 = reach_v1;
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] < _e23) {
                        let _e28 = m.shared_sums[([t as u32, 0, 0])[0] as usize];
                        let _e31 = reach_v1;
                        let _e34 = m.shared_sums[([t as u32, 0, 0])[0].wrapping_add(_e31) as usize];
                        m.shared_sums[([t as u32, 0, 0])[0] as usize] = zip(_e28, _e34, |x, y| (x + y));
                    }
                }
            }
        }
        let _e36 = reach_v1;
        reach_v1 = (_e36 / 2u32);
    }
    'r1: for t in 0..256 {
        if (([t as u32, 0, 0])[0] != 0u32) {
            continue 'r1;
        }
        let sum_e44 = m.shared_sums[0];
        if ((sum_e44)[1] > 0.0f32) {
            if ((sum_e44)[0].abs() < (1000000.0f32 * (sum_e44)[1])) {
                best_v2[t] = (1.0f32 - ((sum_e44)[0] / (sum_e44)[1]));
            } else {
                if ((sum_e44)[0] > 0.0f32) {
                    best_v2[t] = 0.3f32;
                } else {
                    best_v2[t] = 2.0f32;
                }
            }
        }
        let _e69 = <f32>::load(m.factor, 1);
        let most_e72 = 2.0f32.min(_e69).max(1.0f32);
        let _e73 = best_v2[t];
        let s_e76 = _e73.max(0.3f32).min(most_e72);
        Stored::store(s_e76, m.factor, 0);
        let _e83 = <f32>::load(m.factor, 1);
        Stored::store((_e83 / s_e76), m.factor, 1);
    }
}

pub fn run(bound: Bound<'_>) {
    let sums = bound.read(0);
    let mut factor = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
        sums: &sums,
        factor: &mut factor,
        shared_sums: [[0.0f32; 2]; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [[0.0f32; 2]; 256];
        main(&mut m, group as u32);
    }
}
}
