// Written from `shader/newton/guess_products.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "guess_products",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/newton/guess_products.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const THREADS: u32 = 256u32;

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
use crate::kernels::guess_products::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    direction: &'a [u32],
    image: &'a [u32],
    second: &'a [u32],
    second_image: &'a [u32],
    right_side: &'a [u32],
    sums: &'a mut [u32],
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

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut products_v0: [[f32; 5]; 256] = [[0.0f32; 5]; 256];
    let mut k_v2: u32 = 0u32;
    let mut _e79: [f32; 256] = [0.0f32; 256];
    let mut sum_e80: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        let mut i_v1: u32;
        i_v1 = 256u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(([t as u32, 0, 0])[0]);
        'l0: loop {
            'c0: {
                let _e9 = i_v1;
                let _e12 = m.params.nodes;
                if (_e9 < _e12) {
                } else {
                    break 'l0;
                }
                {
                    let _e15 = i_v1;
                    let _e17 = <[f32; 4]>::load(m.right_side, 4 * (_e15 as usize));
                    let b_e18 = swizzle(_e17, [0, 1, 2]);
                    let _e20 = i_v1;
                    let _e22 = <[f32; 4]>::load(m.direction, 4 * (_e20 as usize));
                    let g_e23 = swizzle(_e22, [0, 1, 2]);
                    let _e25 = i_v1;
                    let _e27 = <[f32; 4]>::load(m.image, 4 * (_e25 as usize));
                    let q_e28 = swizzle(_e27, [0, 1, 2]);
                    let _e30 = products_v0[t][0];
                    products_v0[t][0] = (_e30 + dot(g_e23, q_e28));
                    let _e34 = products_v0[t][1];
                    products_v0[t][1] = (_e34 + dot(g_e23, b_e18));
                    let _e39 = m.params.count;
                    if (_e39 == 2u32) {
                        let _e43 = i_v1;
                        let _e45 = <[f32; 4]>::load(m.second, 4 * (_e43 as usize));
                        let other_e46 = swizzle(_e45, [0, 1, 2]);
                        let _e48 = products_v0[t][2];
                        products_v0[t][2] = (_e48 + dot(other_e46, q_e28));
                        let _e52 = products_v0[t][3];
                        let _e54 = i_v1;
                        let _e56 = <[f32; 4]>::load(m.second_image, 4 * (_e54 as usize));
                        products_v0[t][3] = (_e52 + dot(other_e46, swizzle(_e56, [0, 1, 2])));
                        let _e61 = products_v0[t][4];
                        products_v0[t][4] = (_e61 + dot(other_e46, b_e18));
                    }
                }
            }
            let _e64 = i_v1;
            let _e68 = m.params.workgroups;
            i_v1 = _e64.wrapping_add(256u32.wrapping_mul(_e68));
        }
    }
    'l1: loop {
        'c1: {
            let _e73 = k_v2;
            if (_e73 < 5u32) {
            } else {
                break 'l1;
            }
            {
                let _e77 = k_v2;
                for t in 0..256 {
                    _e79[t] = products_v0[t][_e77 as usize];
                }
                sum_e80 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e79[t]));
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        let _e87 = m.params.first;
                        let _e92 = k_v2;
                        Stored::store(sum_e80[t], m.sums, 1 * (_e87.wrapping_add(8u32.wrapping_mul(([group, 0, 0])[0])).wrapping_add(_e92) as usize));
                    }
                }
            }
        }
        let _e95 = k_v2;
        k_v2 = _e95.wrapping_add(1u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let direction = bound.read(0);
    let image = bound.read(1);
    let second = bound.read(2);
    let second_image = bound.read(3);
    let right_side = bound.read(4);
    let mut sums = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        direction: &direction,
        image: &image,
        second: &second,
        second_image: &second_image,
        right_side: &right_side,
        sums: &mut sums,
        shared_sums: [0.0f32; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        main(&mut m, group as u32);
    }
}
}
