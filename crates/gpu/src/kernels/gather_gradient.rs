// Written from `shader/elements/gather_gradient.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "gather_gradient",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/terms.wgsl"),
        include_str!("../../shader/elements/gather_gradient.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct NodeParams {
    pub nodes: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::gather_gradient::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Pair {
    pub node: u32,
    pub value: f32,
}

impl Pair {
    const ZERO: Self = Self {
        node: 0u32,
        value: 0.0f32,
    };
}

impl Stored for Pair {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            node: <u32>::load(words, at + 0),
            value: <f32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.node.store(words, at + 0);
        self.value.store(words, at + 1);
    }
}

struct Memory<'a> {
    params: NodeParams,
    ranges: &'a [u32],
    sources: &'a [u32],
    gradients: &'a [u32],
    pairs: &'a [u32],
    terms: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    gradient: &'a mut [u32],
}

pub fn row_sum_times(m: &mut Memory<'_>, i_a0: u32, x_a1: [f32; 3]) -> [f32; 3] {
    let r_e5 = <[f32; 6]>::load(m.terms, 9 * (i_a0 as usize));
    let _e16 = ((((r_e5)[0] * (x_a1)[0]) + ((r_e5)[1] * (x_a1)[1])) + ((r_e5)[2] * (x_a1)[2]));
    let _e27 = ((((r_e5)[1] * (x_a1)[0]) + ((r_e5)[3] * (x_a1)[1])) + ((r_e5)[4] * (x_a1)[2]));
    let _e38 = ((((r_e5)[2] * (x_a1)[0]) + ((r_e5)[4] * (x_a1)[1])) + ((r_e5)[5] * (x_a1)[2]));
    return [_e16, _e27, _e38];
}

pub fn linear_term(m: &mut Memory<'_>, i_a0: u32) -> [f32; 3] {
    let c_e4 = <[f32; 3]>::load(m.terms, 9 * (i_a0 as usize) + 6);
    let _e5 = (c_e4)[0];
    let _e6 = (c_e4)[1];
    let _e7 = (c_e4)[2];
    return [_e5, _e6, _e7];
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut i_v0: u32;
    i_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = i_v0;
            let _e6 = m.params.nodes;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = i_v0;
                let range_e11 = <[u32; 4]>::load(m.ranges, 4 * (_e9 as usize));
                let _e13 = i_v0;
                let _e15 = <[i32; 4]>::load(m.positions, 4 * (_e13 as usize));
                let _e18 = i_v0;
                let _e20 = <[i32; 4]>::load(m.start, 4 * (_e18 as usize));
                let own_e22 = zip(swizzle(_e15, [0, 1, 2]), swizzle(_e20, [0, 1, 2]), |x, y| x.wrapping_sub(y));
                let _e23 = i_v0;
                let _e27 = m.params.quantum;
                let _e29 = row_sum_times(m, _e23, own_e22.map(|x| (x as f32)).map(|x| (x * _e27)));
                let _e30 = i_v0;
                let _e31 = linear_term(m, _e30);
                let mut sum_v1: [f32; 3];
                sum_v1 = zip(_e29, _e31, |x, y| (x + y));
                let mut k_v2: u32;
                k_v2 = (range_e11)[2];
                'l1: loop {
                    'c1: {
                        let _e36 = k_v2;
                        if (_e36 < (range_e11)[3]) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e40 = k_v2;
                            let pair_e42 = <Pair>::load(m.pairs, 2 * (_e40 as usize));
                            let _e46 = <[i32; 4]>::load(m.positions, 4 * ((pair_e42).node as usize));
                            let _e51 = <[i32; 4]>::load(m.start, 4 * ((pair_e42).node as usize));
                            let other_e53 = zip(swizzle(_e46, [0, 1, 2]), swizzle(_e51, [0, 1, 2]), |x, y| x.wrapping_sub(y));
                            let _e54 = sum_v1;
                            let _e59 = m.params.quantum;
                            sum_v1 = zip(_e54, zip(other_e53, own_e22, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * (_e59 * (pair_e42).value))), |x, y| (x + y));
                        }
                    }
                    let _e64 = k_v2;
                    k_v2 = _e64.wrapping_add(1u32);
                }
                let mut k_v3: u32;
                k_v3 = (range_e11)[0];
                'l2: loop {
                    'c2: {
                        let _e69 = k_v3;
                        if (_e69 < (range_e11)[1]) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e74 = k_v3;
                            let _e76 = <u32>::load(m.sources, 1 * (_e74 as usize));
                            let at_e77 = 3u32.wrapping_mul(_e76);
                            let _e78 = sum_v1;
                            let _e81 = <f32>::load(m.gradients, 1 * (at_e77 as usize));
                            let _e86 = <f32>::load(m.gradients, 1 * (at_e77.wrapping_add(1u32) as usize));
                            let _e91 = <f32>::load(m.gradients, 1 * (at_e77.wrapping_add(2u32) as usize));
                            sum_v1 = zip(_e78, [_e81, _e86, _e91], |x, y| (x + y));
                        }
                    }
                    let _e94 = k_v3;
                    k_v3 = _e94.wrapping_add(1u32);
                }
                let _e98 = i_v0;
                let _e100 = sum_v1;
                Stored::store([(_e100)[0], (_e100)[1], (_e100)[2], 0.0f32], m.gradient, 4 * (_e98 as usize));
            }
        }
        let _e103 = i_v0;
        i_v0 = _e103.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let ranges = bound.read(0);
    let sources = bound.read(1);
    let gradients = bound.read(2);
    let pairs = bound.read(3);
    let terms = bound.read(4);
    let positions = bound.read(5);
    let start = bound.read(6);
    let mut gradient = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        ranges: &ranges,
        sources: &sources,
        gradients: &gradients,
        pairs: &pairs,
        terms: &terms,
        positions: &positions,
        start: &start,
        gradient: &mut gradient,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
