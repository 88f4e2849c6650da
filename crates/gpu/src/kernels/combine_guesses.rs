// Written from `shader/newton/combine_guesses.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "combine_guesses",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/newton.wgsl"),
        include_str!("../../shader/newton/combine_guesses.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const THREADS: u32 = 256u32;
pub const MIN_CONJUGATE: f32 = 1e-5f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub count: u32,
    pub workgroups: u32,
    pub first: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::combine_guesses::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    image: &'a [u32],
    second: &'a [u32],
    second_image: &'a [u32],
    right_side: &'a [u32],
    sums: &'a [u32],
    solve: &'a [u32],
    direction: &'a mut [u32],
    step: &'a mut [u32],
    shared_sums: [f32; 256],
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

pub fn is_positive(number_a0: f32) -> bool {
    let mut local_v0: bool;
    if (number_a0 > 0.0f32) {
        local_v0 = ((number_a0.to_bits() & 2139095040u32) != 2139095040u32);
    } else {
        local_v0 = false;
    }
    let _e11 = local_v0;
    return _e11;
}

pub fn product(m: &mut Memory<'_>, thread_a0: [u32; 256], column_a1: [u32; 256]) -> [f32; 256] {
    let mut sum_v0: [f32; 256] = [0.0f32; 256];
    let mut _e26: [f32; 256] = [0.0f32; 256];
    let mut _e27: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        let mut k_v1: u32;
        k_v1 = thread_a0[t];
        'l0: loop {
            'c0: {
                let _e5 = k_v1;
                let _e8 = m.params.workgroups;
                if (_e5 < _e8) {
                } else {
                    break 'l0;
                }
                {
                    let _e10 = sum_v0[t];
                    let _e14 = m.params.first;
                    let _e16 = k_v1;
                    let _e21 = <f32>::load(m.sums, 1 * (_e14.wrapping_add(8u32.wrapping_mul(_e16)).wrapping_add(column_a1[t]) as usize));
                    sum_v0[t] = (_e10 + _e21);
                }
            }
            let _e23 = k_v1;
            k_v1 = _e23.wrapping_add(256u32);
        }
        _e26[t] = sum_v0[t];
    }
    _e27 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| thread_a0[t]), std::array::from_fn::<_, 256, _>(|t| _e26[t]));
    return std::array::from_fn::<_, 256, _>(|t| _e27[t]);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut along_v0: [f32; 256] = [0.0f32; 256];
    let mut along_other_v1: [f32; 256] = [0.0f32; 256];
    let mut share_v2: [f32; 256] = [0.0f32; 256];
    let mut curvature_e4: [f32; 256] = [0.0f32; 256];
    let mut slope_e7: [f32; 256] = [0.0f32; 256];
    let mut mixed_e10: [f32; 256] = [0.0f32; 256];
    let mut other_curvature_e13: [f32; 256] = [0.0f32; 256];
    let mut other_slope_e16: [f32; 256] = [0.0f32; 256];
    curvature_e4 = product(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| 0u32));
    slope_e7 = product(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| 1u32));
    mixed_e10 = product(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| 2u32));
    other_curvature_e13 = product(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| 3u32));
    other_slope_e16 = product(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| 4u32));
    for t in 0..256 {
        let _e25 = <f32>::load(m.solve, 2);
        let _e26 = is_positive(_e25);
        if _e26 {
            let _e27 = is_positive(curvature_e4[t]);
            if _e27 {
                along_v0[t] = (slope_e7[t] / curvature_e4[t]);
                share_v2[t] = ((-mixed_e10[t]) / curvature_e4[t]);
            }
            let _e33 = m.params.count;
            if (_e33 == 2u32) {
                let _e36 = share_v2[t];
                let conjugate_e38 = (other_curvature_e13[t] + (_e36 * mixed_e10[t]));
                let _e39 = is_positive(conjugate_e38);
                let mut local_v3: bool;
                if _e39 {
                    local_v3 = (conjugate_e38 > (1e-5f32 * other_curvature_e13[t]));
                } else {
                    local_v3 = false;
                }
                let _e46 = local_v3;
                if _e46 {
                    let _e47 = share_v2[t];
                    along_other_v1[t] = ((other_slope_e16[t] + (_e47 * slope_e7[t])) / conjugate_e38);
                    let _e51 = along_v0[t];
                    let _e52 = along_other_v1[t];
                    let _e53 = share_v2[t];
                    along_v0[t] = (_e51 + (_e52 * _e53));
                }
            }
        }
        let mut i_v4: u32;
        i_v4 = ([256 * group + t as u32, 0, 0])[0];
        'l0: loop {
            'c0: {
                let _e58 = i_v4;
                let _e61 = m.params.nodes;
                if (_e58 < _e61) {
                } else {
                    break 'l0;
                }
                {
                    let _e64 = i_v4;
                    let b_e66 = <[f32; 4]>::load(m.right_side, 4 * (_e64 as usize));
                    let _e67 = along_v0[t];
                    let _e69 = i_v4;
                    let _e71 = <[f32; 4]>::load(m.direction, 4 * (_e69 as usize));
                    let mut p_v5: [f32; 3];
                    p_v5 = swizzle(_e71, [0, 1, 2]).map(|x| (_e67 * x));
                    let _e75 = along_v0[t];
                    let _e77 = i_v4;
                    let _e79 = <[f32; 4]>::load(m.image, 4 * (_e77 as usize));
                    let mut q_v6: [f32; 3];
                    q_v6 = swizzle(_e79, [0, 1, 2]).map(|x| (_e75 * x));
                    let _e85 = m.params.count;
                    if (_e85 == 2u32) {
                        let _e88 = p_v5;
                        let _e89 = along_other_v1[t];
                        let _e91 = i_v4;
                        let _e93 = <[f32; 4]>::load(m.second, 4 * (_e91 as usize));
                        p_v5 = zip(_e88, swizzle(_e93, [0, 1, 2]).map(|x| (_e89 * x)), |x, y| (x + y));
                        let _e97 = q_v6;
                        let _e98 = along_other_v1[t];
                        let _e100 = i_v4;
                        let _e102 = <[f32; 4]>::load(m.second_image, 4 * (_e100 as usize));
                        q_v6 = zip(_e97, swizzle(_e102, [0, 1, 2]).map(|x| (_e98 * x)), |x, y| (x + y));
                    }
                    let _e107 = i_v4;
                    let _e109 = p_v5;
                    Stored::store([(_e109)[0], (_e109)[1], (_e109)[2], 0.0f32], m.step, 4 * (_e107 as usize));
                    let mut r_v7: [f32; 3];
                    r_v7 = [0.0f32; 3];
                    if ((b_e66)[3] == 1.0f32) {
                        let _e120 = <f32>::load(m.solve, 0);
                        let _e122 = q_v6;
                        r_v7 = zip(swizzle(b_e66, [0, 1, 2]), _e122, |x, y| (x - y)).map(|x| (_e120 * x));
                    }
                    let _e126 = i_v4;
                    let _e128 = r_v7;
                    Stored::store([(_e128)[0], (_e128)[1], (_e128)[2], 0.0f32], m.direction, 4 * (_e126 as usize));
                }
            }
            let _e131 = i_v4;
            i_v4 = _e131.wrapping_add(16776960u32);
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let image = bound.read(0);
    let second = bound.read(1);
    let second_image = bound.read(2);
    let right_side = bound.read(3);
    let sums = bound.read(4);
    let solve = bound.read(5);
    let mut direction = bound.write(6);
    let mut step = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        image: &image,
        second: &second,
        second_image: &second_image,
        right_side: &right_side,
        sums: &sums,
        solve: &solve,
        direction: &mut direction,
        step: &mut step,
        shared_sums: [0.0f32; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        main(&mut m, group as u32);
    }
}
}
