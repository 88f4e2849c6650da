// Written from `shader/newton/reduce_trial.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "reduce_trial",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/largest.wgsl"),
        include_str!("../../shader/newton/reduce_trial.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const THREADS: u32 = 256u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub count: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::reduce_trial::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    sums: &'a [u32],
    summary: &'a mut [u32],
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
    let mut part_v0: [f32; 256] = [0.0f32; 256];
    let mut k_v2: u32 = 1u32;
    let mut t_e1: [u32; 256] = [0u32; 256];
    let mut _e21: [f32; 256] = [0.0f32; 256];
    let mut sum_e22: [f32; 256] = [0.0f32; 256];
    let mut found_e37: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        t_e1[t] = ([t as u32, 0, 0])[0];
        let mut k_v1: u32;
        k_v1 = t_e1[t];
        'l0: loop {
            'c0: {
                let _e5 = k_v1;
                let _e8 = m.params.count;
                if (_e5 < _e8) {
                } else {
                    break 'l0;
                }
                {
                    let _e10 = part_v0[t];
                    let _e13 = k_v1;
                    let _e16 = <f32>::load(m.sums, 1 * (8u32.wrapping_mul(_e13) as usize));
                    part_v0[t] = (_e10 + _e16);
                }
            }
            let _e18 = k_v1;
            k_v1 = _e18.wrapping_add(256u32);
        }
        _e21[t] = part_v0[t];
    }
    sum_e22 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| t_e1[t]), std::array::from_fn::<_, 256, _>(|t| _e21[t]));
    for t in 0..256 {
        if (t_e1[t] == 0u32) {
            Stored::store(sum_e22[t], m.summary, 0);
        }
    }
    'l1: loop {
        'c1: {
            let _e29 = k_v2;
            if (_e29 < 5u32) {
            } else {
                break 'l1;
            }
            {
                let _e32 = k_v2;
                let _e35 = m.params.count;
                found_e37 = largest_of_parts(m, std::array::from_fn::<_, 256, _>(|t| t_e1[t]), std::array::from_fn::<_, 256, _>(|t| _e32), std::array::from_fn::<_, 256, _>(|t| _e35), std::array::from_fn::<_, 256, _>(|t| 8u32));
                for t in 0..256 {
                    if (t_e1[t] == 0u32) {
                        let _e41 = k_v2;
                        Stored::store(found_e37[t], m.summary, 1 * (_e41 as usize));
                    }
                }
            }
        }
        let _e43 = k_v2;
        k_v2 = _e43.wrapping_add(1u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let sums = bound.read(0);
    let mut summary = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
        sums: &sums,
        summary: &mut summary,
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
