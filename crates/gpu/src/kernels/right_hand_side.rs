// Written from `shader/newton/right_hand_side.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "right_hand_side",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/largest.wgsl"),
        include_str!("../../shader/shared/newton.wgsl"),
        include_str!("../../shader/shared/free.wgsl"),
        include_str!("../../shader/newton/right_hand_side.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const THREADS: u32 = 256u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub springs: u32,
    pub imposed: u32,
    pub workgroups: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::right_hand_side::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    gradient: &'a [u32],
    image: &'a [u32],
    springs: &'a [u32],
    spring_words: &'a [u32],
    free: &'a [u32],
    right_side: &'a mut [u32],
    sums: &'a mut [u32],
    shared_sums: [f32; 256],
    shared_largest: [f32; 256],
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
    let mut largest_v0: [f32; 256] = [0.0f32; 256];
    let mut _e105: [f32; 256] = [0.0f32; 256];
    let mut all_e106: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        let mut i_v1: u32;
        i_v1 = 256u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(([t as u32, 0, 0])[0]);
        'l0: loop {
            'c0: {
                let _e10 = i_v1;
                let _e13 = m.params.nodes;
                if (_e10 < _e13) {
                } else {
                    break 'l0;
                }
                {
                    let mut b_v2: [f32; 4];
                    b_v2 = [0.0f32; 4];
                    let _e18 = i_v1;
                    let _e19 = is_free(m, _e18);
                    if _e19 {
                        let _e21 = i_v1;
                        let _e23 = <[f32; 4]>::load(m.gradient, 4 * (_e21 as usize));
                        let mut sum_v3: [f32; 3];
                        sum_v3 = swizzle(_e23, [0, 1, 2]);
                        let _e28 = m.params.imposed;
                        if (_e28 == 1u32) {
                            let _e31 = sum_v3;
                            let _e33 = i_v1;
                            let _e35 = <[f32; 4]>::load(m.image, 4 * (_e33 as usize));
                            sum_v3 = zip(_e31, swizzle(_e35, [0, 1, 2]), |x, y| (x + y));
                        }
                        let _e40 = m.params.springs;
                        if (_e40 > 0u32) {
                            let _e44 = i_v1;
                            let end_e48 = <u32>::load(m.spring_words, 1 * (_e44.wrapping_add(1u32) as usize));
                            let _e50 = i_v1;
                            let _e52 = <u32>::load(m.spring_words, 1 * (_e50 as usize));
                            let mut e_v4: u32;
                            e_v4 = _e52;
                            'l1: loop {
                                'c1: {
                                    let _e54 = e_v4;
                                    if (_e54 < end_e48) {
                                    } else {
                                        break 'l1;
                                    }
                                    {
                                        let _e58 = e_v4;
                                        let _e60 = <u32>::load(m.spring_words, 1 * (_e58 as usize));
                                        let hessian_e63 = <[[f32; 4]; 3]>::load(m.springs, 20 * (_e60 as usize) + 8);
                                        let _e65 = ((hessian_e63)[0])[3];
                                        let _e67 = ((hessian_e63)[1])[3];
                                        let _e69 = ((hessian_e63)[2])[3];
                                        let force_e70 = [_e65, _e67, _e69];
                                        let _e71 = sum_v3;
                                        let _e73 = e_v4;
                                        let _e77 = <u32>::load(m.spring_words, 1 * (_e73.wrapping_add(1u32) as usize));
                                        sum_v3 = zip(_e71, force_e70.map(|x| (f32::from_bits(_e77 as u32) * x)), |x, y| (x - y));
                                    }
                                }
                                let _e81 = e_v4;
                                e_v4 = _e81.wrapping_add(2u32);
                            }
                        }
                        let _e84 = sum_v3;
                        let _e85 = _e84.map(|x| (-x));
                        b_v2 = [(_e85)[0], (_e85)[1], (_e85)[2], 1.0f32];
                    }
                    let _e89 = i_v1;
                    let _e91 = b_v2;
                    Stored::store(_e91, m.right_side, 4 * (_e89 as usize));
                    let _e92 = largest_v0[t];
                    let _e93 = b_v2;
                    let _e95 = largest_component(swizzle(_e93, [0, 1, 2]));
                    largest_v0[t] = _e92.max(_e95);
                }
            }
            let _e97 = i_v1;
            let _e101 = m.params.workgroups;
            i_v1 = _e97.wrapping_add(256u32.wrapping_mul(_e101));
        }
        _e105[t] = largest_v0[t];
    }
    all_e106 = largest_of_threads(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e105[t]));
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            Stored::store(all_e106[t], m.sums, 1 * (([group, 0, 0])[0] as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let gradient = bound.read(0);
    let image = bound.read(1);
    let springs = bound.read(2);
    let spring_words = bound.read(3);
    let free = bound.read(4);
    let mut right_side = bound.write(5);
    let mut sums = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        gradient: &gradient,
        image: &image,
        springs: &springs,
        spring_words: &spring_words,
        free: &free,
        right_side: &mut right_side,
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
