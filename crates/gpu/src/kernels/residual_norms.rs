// Written from `shader/newton/residual_norms.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "residual_norms",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/segments.wgsl"),
        include_str!("../../shader/newton/residual_norms.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write],
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
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::residual_norms::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    blocks: &'a [u32],
    solution: &'a [u32],
    direction: &'a [u32],
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
    let mut _e44: [u32; 256] = [0u32; 256];
    let mut _e45: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
    let mut sum_e46: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
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
                        let _e29 = m.params.nodes;
                        let _e32 = <[f32; 4]>::load(m.solution, 4 * (_e29.wrapping_add(i_e13) as usize));
                        let r_e33 = swizzle(_e32, [0, 1, 2]);
                        let _e36 = <[f32; 4]>::load(m.direction, 4 * (i_e13 as usize));
                        let _e38 = dot(r_e33, swizzle(_e36, [0, 1, 2]));
                        let _e39 = dot(r_e33, r_e33);
                        value_v2 = [_e38, _e39, 0.0f32, 0.0f32];
                    }
                    _e44[t] = segment_v1[t];
                    _e45[t] = value_v2;
                }
                sum_e46 = sum_of_segment(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e44[t]), std::array::from_fn::<_, 256, _>(|t| _e45[t]));
                for t in 0..256 {
                    let _e48 = segment_v1[t];
                    let _e49 = is_first_of_segment(m, ([t as u32, 0, 0])[0], _e48);
                    if _e49 {
                        let _e51 = segment_v1[t];
                        Stored::store(sum_e46[t], m.totals, 4 * (_e51 as usize));
                    }
                }
            }
        }
        let _e53 = first_v0;
        first_v0 = _e53.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let blocks = bound.read(0);
    let solution = bound.read(1);
    let direction = bound.read(2);
    let mut totals = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        blocks: &blocks,
        solution: &solution,
        direction: &direction,
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
