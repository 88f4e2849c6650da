// Written from `shader/forward/max_stretch.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "max_stretch",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/most.wgsl"),
        include_str!("../../shader/forward/max_stretch.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write],
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
pub const WORDS: u32 = 1u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub edges: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::max_stretch::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    limits: &'a [u32],
    control: &'a mut [u32],
    most: [u32; 256],
}

pub fn find_most(m: &mut Memory<'_>, thread_a0: [u32; 256], own_a1: [[u32; 1]; 256]) {
    let mut k_v0: [u32; 256] = [0u32; 256];
    let mut reach_v1: u32 = 128u32;
    for t in 0..256 {
        'l0: loop {
            'c0: {
                let _e4 = k_v0[t];
                if (_e4 < 1u32) {
                } else {
                    break 'l0;
                }
                {
                    let _e9 = k_v0[t];
                    let _e13 = k_v0[t];
                    m.most[256u32.wrapping_mul(_e9).wrapping_add(thread_a0[t]) as usize] = (own_a1[t])[_e13 as usize];
                }
            }
            let _e15 = k_v0[t];
            k_v0[t] = _e15.wrapping_add(1u32);
        }
    }
    'l1: loop {
        'c1: {
            let _e20 = reach_v1;
            if (_e20 > 0u32) {
            } else {
                break 'l1;
            }
            {
                let _e23 = reach_v1;
                for t in 0..256 {
                    if (thread_a0[t] < _e23) {
                        let mut k_v2: u32;
                        k_v2 = 0u32;
                        'l2: loop {
                            'c2: {
                                let _e27 = k_v2;
                                if (_e27 < 1u32) {
                                } else {
                                    break 'l2;
                                }
                                {
                                    let _e31 = k_v2;
                                    let at_e33 = 256u32.wrapping_mul(_e31).wrapping_add(thread_a0[t]);
                                    let _e38 = m.most[at_e33 as usize];
                                    let _e40 = reach_v1;
                                    let _e43 = m.most[at_e33.wrapping_add(_e40) as usize];
                                    m.most[at_e33 as usize] = _e38.max(_e43);
                                }
                            }
                            let _e45 = k_v2;
                            k_v2 = _e45.wrapping_add(1u32);
                        }
                    }
                }
            }
        }
        let _e48 = reach_v1;
        reach_v1 = (_e48 / 2u32);
    }
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut largest_v0: [u32; 256] = [0u32; 256];
    let mut _e46: [u32; 256] = [0u32; 256];
    for t in 0..256 {
        let mut e_v1: u32;
        e_v1 = ([256 * group + t as u32, 0, 0])[0];
        'l0: loop {
            'c0: {
                let _e6 = e_v1;
                let _e9 = m.params.edges;
                if (_e6 < _e9) {
                } else {
                    break 'l0;
                }
                {
                    let _e13 = e_v1;
                    let _e16 = <u32>::load(m.limits, 8 * (_e13 as usize) + 1);
                    let _e18 = <[i32; 4]>::load(m.positions, 4 * (_e16 as usize));
                    let _e22 = e_v1;
                    let _e25 = <u32>::load(m.limits, 8 * (_e22 as usize));
                    let _e27 = <[i32; 4]>::load(m.positions, 4 * (_e25 as usize));
                    let edge_e30 = zip(swizzle(_e18, [0, 1, 2]), swizzle(_e27, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                    let _e31 = largest_v0[t];
                    let _e35 = e_v1;
                    let _e38 = <f32>::load(m.limits, 8 * (_e35 as usize) + 2);
                    largest_v0[t] = _e31.max((dot(edge_e30, edge_e30).sqrt() / _e38).to_bits());
                }
            }
            let _e42 = e_v1;
            e_v1 = _e42.wrapping_add(16776960u32);
        }
        _e46[t] = largest_v0[t];
    }
    find_most(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| [_e46[t]]));
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e55 = m.most[0];
            { let old = <u32>::load(m.control, 11); let new = old.max(_e55); Stored::store(new, m.control, 11); old };
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let limits = bound.read(1);
    let mut control = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        limits: &limits,
        control: &mut control,
        most: [0u32; 256],
    };
    for group in 0..bound.workgroups() {
        m.most = [0u32; 256];
        main(&mut m, group as u32);
    }
}
}
