// Written from `shader/newton/block_momenta.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "block_momenta",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/segments.wgsl"),
        include_str!("../../shader/newton/block_momenta.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const WINDOW: u32 = 256u32;
pub const NO_SEGMENT: u32 = 4294967295u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::block_momenta::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    blocks: &'a [u32],
    iterate: &'a [u32],
    start: &'a [u32],
    row_sums: &'a [u32],
    step: &'a [u32],
    totals: &'a mut [u32],
    shared_values: [[f32; 4]; 256],
    shared_segments: [u32; 256],
}

pub fn sum_of_segment(m: &mut Memory<'_>, thread_a0: [u32; 256], segment_a1: [u32; 256], value_a2: [[f32; 4]; 256]) -> [[f32; 4]; 256] {
    let mut reach_v0: u32 = 1u32;
    let mut other_v1: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
    let mut _e44: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
    for t in 0..256 {
        m.shared_values[thread_a0[t] as usize] = value_a2[t];
        m.shared_segments[thread_a0[t] as usize] = segment_a1[t];
    }
    'l0: loop {
        'c0: {
            let _e9 = reach_v0;
            if (_e9 < 256u32) {
            } else {
                break 'l0;
            }
            {
                let _e15 = reach_v0;
                for t in 0..256 {
                    other_v1[t] = [0.0f32; 4];
                    let mut local_v2: bool;
                    if (thread_a0[t].wrapping_add(_e15) < 256u32) {
                        let _e22 = reach_v0;
                        let _e25 = m.shared_segments[thread_a0[t].wrapping_add(_e22) as usize];
                        local_v2 = (_e25 == segment_a1[t]);
                    } else {
                        local_v2 = false;
                    }
                    let _e28 = local_v2;
                    if _e28 {
                        let _e30 = reach_v0;
                        let _e33 = m.shared_values[thread_a0[t].wrapping_add(_e30) as usize];
                        other_v1[t] = _e33;
                    }
                }
                for t in 0..256 {
                    let _e36 = m.shared_values[thread_a0[t] as usize];
                    let _e37 = other_v1[t];
                    m.shared_values[thread_a0[t] as usize] = zip(_e36, _e37, |x, y| (x + y));
                }
            }
        }
        let _e39 = reach_v0;
        reach_v0 = _e39.wrapping_mul(2u32);
    }
    for t in 0..256 {
        _e44[t] = m.shared_values[thread_a0[t] as usize];
    }
    return std::array::from_fn::<_, 256, _>(|t| _e44[t]);
}

pub fn is_first_of_segment(m: &mut Memory<'_>, thread_a0: u32, segment_a1: u32) -> bool {
    let mut local_v0: bool;
    if (segment_a1 != 4294967295u32) {
        let mut local_v1: bool;
        if (!(thread_a0 == 0u32)) {
            let _e15 = m.shared_segments[thread_a0.wrapping_sub(1u32) as usize];
            local_v1 = (_e15 != segment_a1);
        } else {
            local_v1 = true;
        }
        let _e18 = local_v1;
        local_v0 = _e18;
    } else {
        local_v0 = false;
    }
    let _e20 = local_v0;
    return _e20;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut first_v0: u32 = 0u32;
    let mut segment_v1: [u32; 256] = [0u32; 256];
    let mut _e117: [u32; 256] = [0u32; 256];
    let mut _e118: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
    let mut sum_e119: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
    first_v0 = 256u32.wrapping_mul(([group, 0, 0])[0]);
    'l0: loop {
        'c0: {
            let _e6 = first_v0;
            let _e9 = m.params.nodes;
            if (_e6 < _e9) {
            } else {
                break 'l0;
            }
            {
                let _e11 = first_v0;
                let _e21 = m.params.nodes;
                for t in 0..256 {
                    let i_e13 = _e11.wrapping_add(([t as u32, 0, 0])[0]);
                    segment_v1[t] = 4294967295u32;
                    let mut value_v2: [f32; 4];
                    value_v2 = [0.0f32; 4];
                    if (i_e13 < _e21) {
                        let _e25 = <u32>::load(m.blocks, 1 * (i_e13 as usize));
                        segment_v1[t] = _e25;
                        let _e28 = <[i32; 4]>::load(m.iterate, 4 * (i_e13 as usize));
                        let _e32 = <[i32; 4]>::load(m.start, 4 * (i_e13 as usize));
                        let _e38 = m.params.quantum;
                        let _e42 = <[f32; 4]>::load(m.step, 4 * (i_e13 as usize));
                        let d_e44 = zip(zip(swizzle(_e28, [0, 1, 2]), swizzle(_e32, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e38)), swizzle(_e42, [0, 1, 2]), |x, y| (x + y));
                        let at_e46 = 6u32.wrapping_mul(i_e13);
                        let _e49 = <f32>::load(m.row_sums, 1 * (at_e46 as usize));
                        let _e56 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(1u32) as usize));
                        let _e64 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(2u32) as usize));
                        let _e67 = (((_e49 * (d_e44)[0]) + (_e56 * (d_e44)[1])) + (_e64 * (d_e44)[2]));
                        let _e72 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(1u32) as usize));
                        let _e79 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(3u32) as usize));
                        let _e87 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(4u32) as usize));
                        let _e90 = (((_e72 * (d_e44)[0]) + (_e79 * (d_e44)[1])) + (_e87 * (d_e44)[2]));
                        let _e95 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(2u32) as usize));
                        let _e102 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(4u32) as usize));
                        let _e110 = <f32>::load(m.row_sums, 1 * (at_e46.wrapping_add(5u32) as usize));
                        let _e113 = (((_e95 * (d_e44)[0]) + (_e102 * (d_e44)[1])) + (_e110 * (d_e44)[2]));
                        value_v2 = [_e67, _e90, _e113, 0.0f32];
                    }
                    _e117[t] = segment_v1[t];
                    _e118[t] = value_v2;
                }
                sum_e119 = sum_of_segment(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e117[t]), std::array::from_fn::<_, 256, _>(|t| _e118[t]));
                for t in 0..256 {
                    let _e121 = segment_v1[t];
                    let _e122 = is_first_of_segment(m, ([t as u32, 0, 0])[0], _e121);
                    if _e122 {
                        let _e124 = segment_v1[t];
                        Stored::store(sum_e119[t], m.totals, 4 * (_e124 as usize));
                    }
                }
            }
        }
        let _e126 = first_v0;
        first_v0 = _e126.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let blocks = bound.read(0);
    let iterate = bound.read(1);
    let start = bound.read(2);
    let row_sums = bound.read(3);
    let step = bound.read(4);
    let mut totals = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        blocks: &blocks,
        iterate: &iterate,
        start: &start,
        row_sums: &row_sums,
        step: &step,
        totals: &mut totals,
        shared_values: [[0.0f32; 4]; 256],
        shared_segments: [0u32; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_values = [[0.0f32; 4]; 256];
        m.shared_segments = [0u32; 256];
        main(&mut m, group as u32);
    }
}
}
