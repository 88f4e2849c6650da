// Written from `shader/newton/cg_tolerance.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "cg_tolerance",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/largest.wgsl"),
        include_str!("../../shader/shared/newton.wgsl"),
        include_str!("../../shader/newton/cg_tolerance.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const THREADS: u32 = 256u32;
pub const FACTOR: u32 = 0u32;
pub const SCALE: u32 = 1u32;
pub const START: u32 = 2u32;
pub const ROUND: u32 = 3u32;
pub const MARGIN: f32 = 0.9025f32;
pub const MAX_REDUCTION: f32 = 1e-10f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub mode: u32,
    pub first: u32,
    pub count: u32,
    pub tolerance: f32,
    pub own_tolerance: f32,
    pub min_scale: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::cg_tolerance::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    sums: &'a [u32],
    solve: &'a mut [u32],
    progress: &'a mut [u32],
    ended: &'a mut [u32],
    shared_sums: [f32; 256],
    shared_largest: [f32; 256],
}

pub fn sum_of_threads(m: &mut Memory<'_>, thread_a0: [u32; 256], value_a1: [f32; 256]) -> [f32; 256] {
    let mut reach_v0: u32 = 128u32;
    for t in 0..256 {
        m.shared_sums[thread_a0[t] as usize] = value_a1[t];
    }
    'l0: loop {
        'c0: {
            let _e6 = reach_v0;
            if (_e6 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = reach_v0;
                for t in 0..256 {
                    if (thread_a0[t] < _e9) {
                        let _e13 = m.shared_sums[thread_a0[t] as usize];
                        let _e15 = reach_v0;
                        let _e18 = m.shared_sums[thread_a0[t].wrapping_add(_e15) as usize];
                        m.shared_sums[thread_a0[t] as usize] = (_e13 + _e18);
                    }
                }
            }
        }
        let _e20 = reach_v0;
        reach_v0 = (_e20 / 2u32);
    }
    let _e25 = { let t = 0; m.shared_sums[0] };
    return std::array::from_fn::<_, 256, _>(|t| _e25);
}

pub fn sum_of_own_parts(m: &mut Memory<'_>, thread_a0: u32, first_a1: u32, count_a2: u32) -> f32 {
    let mut sum_v0: f32 = 0.0f32;
    let mut k_v1: u32;
    k_v1 = thread_a0;
    'l0: loop {
        'c0: {
            let _e6 = k_v1;
            if (_e6 < count_a2) {
            } else {
                break 'l0;
            }
            {
                let _e8 = sum_v0;
                let _e10 = k_v1;
                let _e13 = <f32>::load(m.sums, 1 * (first_a1.wrapping_add(_e10) as usize));
                sum_v0 = (_e8 + _e13);
            }
        }
        let _e15 = k_v1;
        k_v1 = _e15.wrapping_add(256u32);
    }
    let _e18 = sum_v0;
    return _e18;
}

pub fn sum_of_parts(m: &mut Memory<'_>, thread_a0: [u32; 256], first_a1: [u32; 256], count_a2: [u32; 256]) -> [f32; 256] {
    let mut _e3: [f32; 256] = [0.0f32; 256];
    let mut _e4: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        _e3[t] = sum_of_own_parts(m, thread_a0[t], first_a1[t], count_a2[t]);
    }
    _e4 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| thread_a0[t]), std::array::from_fn::<_, 256, _>(|t| _e3[t]));
    return std::array::from_fn::<_, 256, _>(|t| _e4[t]);
}

pub fn largest_of_threads(m: &mut Memory<'_>, thread_a0: [u32; 256], value_a1: [f32; 256]) -> [f32; 256] {
    let mut reach_v0: u32 = 128u32;
    for t in 0..256 {
        m.shared_largest[thread_a0[t] as usize] = value_a1[t];
    }
    'l0: loop {
        'c0: {
            let _e6 = reach_v0;
            if (_e6 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = reach_v0;
                for t in 0..256 {
                    if (thread_a0[t] < _e9) {
                        let _e15 = m.shared_largest[thread_a0[t] as usize];
                        let _e17 = reach_v0;
                        let _e20 = m.shared_largest[thread_a0[t].wrapping_add(_e17) as usize];
                        m.shared_largest[thread_a0[t] as usize] = _e15.max(_e20);
                    }
                }
            }
        }
        let _e22 = reach_v0;
        reach_v0 = (_e22 / 2u32);
    }
    let _e27 = { let t = 0; m.shared_largest[0] };
    return std::array::from_fn::<_, 256, _>(|t| _e27);
}

pub fn largest_of_parts(m: &mut Memory<'_>, thread_a0: [u32; 256], first_a1: [u32; 256], count_a2: [u32; 256], stride_a3: [u32; 256]) -> [f32; 256] {
    let mut largest_v0: [f32; 256] = [0.0f32; 256];
    let mut _e20: [f32; 256] = [0.0f32; 256];
    let mut _e21: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        let mut k_v1: u32;
        k_v1 = thread_a0[t];
        'l0: loop {
            'c0: {
                let _e7 = k_v1;
                if (_e7 < count_a2[t]) {
                } else {
                    break 'l0;
                }
                {
                    let _e9 = largest_v0[t];
                    let _e11 = k_v1;
                    let _e15 = <f32>::load(m.sums, 1 * (first_a1[t].wrapping_add(stride_a3[t].wrapping_mul(_e11)) as usize));
                    largest_v0[t] = _e9.max(_e15);
                }
            }
            let _e17 = k_v1;
            k_v1 = _e17.wrapping_add(256u32);
        }
        _e20[t] = largest_v0[t];
    }
    _e21 = largest_of_threads(m, std::array::from_fn::<_, 256, _>(|t| thread_a0[t]), std::array::from_fn::<_, 256, _>(|t| _e20[t]));
    return std::array::from_fn::<_, 256, _>(|t| _e21[t]);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut t_e1: [u32; 256] = [0u32; 256];
    let mut largest_e14: [f32; 256] = [0.0f32; 256];
    let mut norm_e46: [f32; 256] = [0.0f32; 256];
    let _e4 = m.params.mode;
    for t in 0..256 {
        t_e1[t] = ([t as u32, 0, 0])[0];
    }
    if (_e4 == 0u32) {
        let _e9 = m.params.first;
        let _e12 = m.params.count;
        largest_e14 = largest_of_parts(m, std::array::from_fn::<_, 256, _>(|t| t_e1[t]), std::array::from_fn::<_, 256, _>(|t| _e9), std::array::from_fn::<_, 256, _>(|t| _e12), std::array::from_fn::<_, 256, _>(|t| 1u32));
        for t in 0..256 {
            if (t_e1[t] == 0u32) {
                let bits_e19 = (largest_e14[t].to_bits() & 2139095040u32);
                let mut local_v0: bool;
                if (bits_e19 > 0u32) {
                    local_v0 = (bits_e19 < 2130706432u32);
                } else {
                    local_v0 = false;
                }
                let is_usual_e27 = local_v0;
                Stored::store(f32::from_bits((if is_usual_e27 { 2130706432u32.wrapping_sub(bits_e19) } else { 1065353216u32 }) as u32), m.solve, 0);
                Stored::store(f32::from_bits((if is_usual_e27 { bits_e19 } else { 1065353216u32 }) as u32), m.solve, 1);
            }
        }
        return;
    }
    let _e42 = m.params.first;
    let _e45 = m.params.count;
    norm_e46 = sum_of_parts(m, std::array::from_fn::<_, 256, _>(|t| t_e1[t]), std::array::from_fn::<_, 256, _>(|t| _e42), std::array::from_fn::<_, 256, _>(|t| _e45));
    'r0: for t in 0..256 {
        if (t_e1[t] != 0u32) {
            continue 'r0;
        }
        let _e51 = m.params.mode;
        if (_e51 == 1u32) {
            Stored::store(norm_e46[t], m.solve, 2);
            continue 'r0;
        }
        let _e58 = m.params.mode;
        if (_e58 == 2u32) {
            let _e63 = <f32>::load(m.solve, 2);
            let mut relative_v1: f32;
            relative_v1 = _e63;
            let _e67 = m.params.min_scale;
            if (_e67 > 0.0f32) {
                let _e70 = relative_v1;
                let _e73 = m.params.min_scale;
                let _e76 = <f32>::load(m.solve, 0);
                let _e80 = <f32>::load(m.solve, 0);
                relative_v1 = _e70.max(((_e73 * _e76) * _e80));
            }
            let _e87 = m.params.tolerance;
            let _e88 = relative_v1;
            let _e92 = m.params.own_tolerance;
            let _e95 = <f32>::load(m.solve, 2);
            Stored::store((_e87 * _e88).max((_e92 * _e95)), m.solve, 5);
            Stored::store(norm_e46[t], m.solve, 4);
            Stored::store(norm_e46[t], m.solve, 6);
            Stored::store(0u32, m.solve, 7);
            Stored::store(0u32, m.solve, 8);
            let _e113 = <f32>::load(m.solve, 5);
            Stored::store((0.9025f32 * _e113).max((1e-10f32 * norm_e46[t])), m.progress, 2);
            Stored::store(1u32, m.progress, 0);
            Stored::store(0u32, m.progress, 1);
            Stored::store(0u32, m.ended, 0);
            continue 'r0;
        }
        let _e131 = <u32>::load(m.progress, 1);
        Stored::store(_e131, m.solve, 7);
        Stored::store(norm_e46[t], m.solve, 6);
        let _e136 = <u32>::load(m.solve, 8);
        if (_e136 == 1u32) {
            let _e143 = <f32>::load(m.solve, 4);
            Stored::store(_e143, m.solve, 3);
            Stored::store(norm_e46[t], m.solve, 4);
            let _e151 = <f32>::load(m.solve, 5);
            Stored::store((0.9025f32 * _e151).max((1e-10f32 * norm_e46[t])), m.progress, 2);
            Stored::store(1u32, m.progress, 0);
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let sums = bound.read(0);
    let mut solve = bound.write(1);
    let mut progress = bound.write(2);
    let mut ended = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        sums: &sums,
        solve: &mut solve,
        progress: &mut progress,
        ended: &mut ended,
        shared_sums: [0.0f32; 256],
        shared_largest: [0.0f32; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        m.shared_largest = [0.0f32; 256];
        main(&mut m, group as u32);
    }
}
}
