// Written from `shader/newton/trial_positions.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "trial_positions",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/largest.wgsl"),
        include_str!("../../shader/shared/newton.wgsl"),
        include_str!("../../shader/shared/free.wgsl"),
        include_str!("../../shader/newton/trial_positions.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const THREADS: u32 = 256u32;
pub const REACH: i32 = 536870911i32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub workgroups: u32,
    pub imposed: u32,
    pub scale: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::trial_positions::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    iterate: &'a [u32],
    imposed: &'a [u32],
    free: &'a [u32],
    step: &'a [u32],
    right_side: &'a [u32],
    target_start: &'a [u32],
    trial: &'a mut [u32],
    sums: &'a mut [u32],
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

pub fn largest_component(v_a0: [f32; 3]) -> f32 {
    let a_e1 = v_a0.map(|x| x.abs());
    return (a_e1)[0].max((a_e1)[1].max((a_e1)[2]));
}

pub fn is_free(m: &mut Memory<'_>, i_a0: u32) -> bool {
    let _e5 = <u32>::load(m.free, 1 * ((i_a0 / 32u32) as usize));
    return ((_e5.wrapping_shr((i_a0 % 32u32)) & 1u32) == 1u32);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut product_v0: [f32; 256] = [0.0f32; 256];
    let mut largest_v1: [[f32; 4]; 256] = [[0.0f32; 4]; 256];
    let mut k_v4: u32 = 0u32;
    let mut t_e2: [u32; 256] = [0u32; 256];
    let mut _e117: [f32; 256] = [0.0f32; 256];
    let mut sum_e118: [f32; 256] = [0.0f32; 256];
    let mut _e133: [f32; 256] = [0.0f32; 256];
    let mut found_e134: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        t_e2[t] = ([t as u32, 0, 0])[0];
        let mut i_v2: u32;
        i_v2 = 256u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(t_e2[t]);
        'l0: loop {
            'c0: {
                let _e13 = i_v2;
                let _e16 = m.params.nodes;
                if (_e13 < _e16) {
                } else {
                    break 'l0;
                }
                {
                    let _e19 = i_v2;
                    let _e21 = <[i32; 4]>::load(m.iterate, 4 * (_e19 as usize));
                    let x_e22 = swizzle(_e21, [0, 1, 2]);
                    let _e24 = i_v2;
                    let _e26 = <[f32; 4]>::load(m.step, 4 * (_e24 as usize));
                    let p_e27 = swizzle(_e26, [0, 1, 2]);
                    let _e28 = product_v0[t];
                    let _e30 = i_v2;
                    let _e32 = <[f32; 4]>::load(m.right_side, 4 * (_e30 as usize));
                    product_v0[t] = (_e28 + dot(p_e27, swizzle(_e32, [0, 1, 2])));
                    let mut y_v3: [i32; 3];
                    y_v3 = x_e22;
                    let _e37 = i_v2;
                    let _e38 = is_free(m, _e37);
                    if _e38 {
                        let _e41 = m.params.scale;
                        if (_e41 != 0.0f32) {
                            let _e46 = m.params.scale;
                            let way_e47 = p_e27.map(|x| (_e46 * x));
                            let _e50 = largest_v1[t][3];
                            let _e53 = largest_component(zip(x_e22.map(|x| (x as f32)), way_e47, |x, y| (x + y)));
                            largest_v1[t][3] = _e50.max(_e53);
                            let limit_e56 = [1073741800.0f32; 3];
                            y_v3 = zip(zip(zip(x_e22, zip(zip(way_e47, limit_e56.map(|x| (-x)), |x, y| x.max(y)), limit_e56, |x, y| x.min(y)).map(|x| x.round_ties_even()).map(|x| (x as i32)), |x, y| x.wrapping_add(y)), [(-536870911i32); 3], |x, y| x.max(y)), [536870911i32; 3], |x, y| x.min(y));
                        }
                        let _e69 = largest_v1[t][0];
                        let _e70 = largest_component(p_e27);
                        largest_v1[t][0] = _e69.max(_e70);
                        let _e72 = y_v3;
                        let moved_e74 = zip(_e72, x_e22, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                        let _e77 = largest_v1[t][1];
                        largest_v1[t][1] = _e77.max(dot(moved_e74, moved_e74));
                        let _e80 = y_v3;
                        let _e82 = i_v2;
                        let _e84 = <[i32; 4]>::load(m.target_start, 4 * (_e82 as usize));
                        let all_e87 = zip(_e80, swizzle(_e84, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                        let _e90 = largest_v1[t][2];
                        largest_v1[t][2] = _e90.max(dot(all_e87, all_e87));
                    } else {
                        let _e95 = m.params.imposed;
                        if (_e95 == 1u32) {
                            let _e99 = i_v2;
                            let _e101 = <[i32; 4]>::load(m.imposed, 4 * (_e99 as usize));
                            y_v3 = zip(x_e22, swizzle(_e101, [0, 1, 2]), |x, y| x.wrapping_add(y));
                        }
                    }
                    let _e105 = i_v2;
                    let _e107 = y_v3;
                    Stored::store([(_e107)[0], (_e107)[1], (_e107)[2], 0i32], m.trial, 4 * (_e105 as usize));
                }
            }
            let _e110 = i_v2;
            let _e114 = m.params.workgroups;
            i_v2 = _e110.wrapping_add(256u32.wrapping_mul(_e114));
        }
        _e117[t] = product_v0[t];
    }
    sum_e118 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| t_e2[t]), std::array::from_fn::<_, 256, _>(|t| _e117[t]));
    for t in 0..256 {
        if (t_e2[t] == 0u32) {
            Stored::store(sum_e118[t], m.sums, 1 * (8u32.wrapping_mul(([group, 0, 0])[0]) as usize));
        }
    }
    'l1: loop {
        'c1: {
            let _e128 = k_v4;
            if (_e128 < 4u32) {
            } else {
                break 'l1;
            }
            {
                let _e131 = k_v4;
                for t in 0..256 {
                    _e133[t] = largest_v1[t][_e131 as usize];
                }
                found_e134 = largest_of_threads(m, std::array::from_fn::<_, 256, _>(|t| t_e2[t]), std::array::from_fn::<_, 256, _>(|t| _e133[t]));
                for t in 0..256 {
                    if (t_e2[t] == 0u32) {
                        let _e143 = k_v4;
                        Stored::store(found_e134[t], m.sums, 1 * (8u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(1u32).wrapping_add(_e143) as usize));
                    }
                }
            }
        }
        let _e146 = k_v4;
        k_v4 = _e146.wrapping_add(1u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let iterate = bound.read(0);
    let imposed = bound.read(1);
    let free = bound.read(2);
    let step = bound.read(3);
    let right_side = bound.read(4);
    let target_start = bound.read(5);
    let mut trial = bound.write(6);
    let mut sums = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        iterate: &iterate,
        imposed: &imposed,
        free: &free,
        step: &step,
        right_side: &right_side,
        target_start: &target_start,
        trial: &mut trial,
        sums: &mut sums,
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
