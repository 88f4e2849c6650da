// Written from `shader/forward/body_residuals.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "body_residuals",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/forward/body_residuals.wgsl"),
    ],
    workgroup: 64,
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::body_residuals::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct BlockSum {
    pub residual: [f32; 3],
    pub mass: f32,
    pub lengths: f32,
    pub padding_0: u32,
    pub padding_1: u32,
    pub padding_2: u32,
}

impl BlockSum {
    const ZERO: Self = Self {
        residual: [0.0f32; 3],
        mass: 0.0f32,
        lengths: 0.0f32,
        padding_0: 0u32,
        padding_1: 0u32,
        padding_2: 0u32,
    };
}

impl Stored for BlockSum {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            residual: <[f32; 3]>::load(words, at + 0),
            mass: <f32>::load(words, at + 3),
            lengths: <f32>::load(words, at + 4),
            padding_0: <u32>::load(words, at + 5),
            padding_1: <u32>::load(words, at + 6),
            padding_2: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.residual.store(words, at + 0);
        self.mass.store(words, at + 3);
        self.lengths.store(words, at + 4);
        self.padding_0.store(words, at + 5);
        self.padding_1.store(words, at + 6);
        self.padding_2.store(words, at + 7);
    }
}

struct Memory<'a> {
    params: Params,
    blocks: &'a [u32],
    sums: &'a [u32],
    control: &'a mut [u32],
    shared_sums: [BlockSum; 64],
}

pub fn joined(a_a0: BlockSum, b_a1: BlockSum) -> BlockSum {
    let mut sum_v0: BlockSum;
    sum_v0 = a_a0;
    let _e4 = sum_v0.residual;
    sum_v0.residual = zip(_e4, (b_a1).residual, |x, y| (x + y));
    let _e8 = sum_v0.mass;
    sum_v0.mass = (_e8 + (b_a1).mass);
    let _e12 = sum_v0.lengths;
    sum_v0.lengths = (_e12 + (b_a1).lengths);
    let _e15 = sum_v0;
    return _e15;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut b_v0: u32 = 0u32;
    let mut reach_v5: u32 = 0u32;
    let mut body_e13: [u32; 64] = [0u32; 64];
    let mut _e28: [bool; 64] = [false; 64];
    b_v0 = ([group, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e4 = b_v0;
            let _e7 = m.params.blocks;
            if (_e4 < _e7) {
            } else {
                break 'l0;
            }
            {
                let _e10 = b_v0;
                let _e14 = b_v0;
                for t in 0..64 {
                    body_e13[t] = <u32>::load(m.blocks, 3 * (_e10 as usize) + 2);
                    let mut local_v1: bool;
                    if (_e14 > 0u32) {
                        let _e20 = b_v0;
                        let _e25 = <u32>::load(m.blocks, 3 * (_e20.wrapping_sub(1u32) as usize) + 2);
                        local_v1 = (_e25 == body_e13[t]);
                    } else {
                        local_v1 = false;
                    }
                    _e28[t] = local_v1;
                }
                if uniform(std::array::from_fn::<_, 64, _>(|t| _e28[t])) {
                    break 'c0;
                }
                let _e31 = b_v0;
                for t in 0..64 {
                    let mut own_v2: BlockSum;
                    own_v2 = BlockSum::ZERO;
                    let mut k_v3: u32;
                    k_v3 = _e31.wrapping_add(([t as u32, 0, 0])[0]);
                    'l1: loop {
                        'c1: {
                            let _e35 = k_v3;
                            let _e38 = m.params.blocks;
                            let mut local_v4: bool;
                            if (_e35 < _e38) {
                                let _e43 = k_v3;
                                let _e46 = <u32>::load(m.blocks, 3 * (_e43 as usize) + 2);
                                local_v4 = (_e46 == body_e13[t]);
                            } else {
                                local_v4 = false;
                            }
                            let _e49 = local_v4;
                            if _e49 {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e50 = own_v2;
                                let _e52 = k_v3;
                                let _e54 = <BlockSum>::load(m.sums, 8 * (_e52 as usize));
                                let _e55 = joined(_e50, _e54);
                                own_v2 = _e55;
                            }
                        }
                        let _e56 = k_v3;
                        k_v3 = _e56.wrapping_add(64u32);
                    }
                    let _e62 = own_v2;
                    m.shared_sums[([t as u32, 0, 0])[0] as usize] = _e62;
                }
                reach_v5 = 32u32;
                'l2: loop {
                    'c2: {
                        let _e65 = reach_v5;
                        if (_e65 > 0u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e69 = reach_v5;
                            for t in 0..64 {
                                if (([t as u32, 0, 0])[0] < _e69) {
                                    let _e77 = m.shared_sums[([t as u32, 0, 0])[0] as usize];
                                    let _e80 = reach_v5;
                                    let _e83 = m.shared_sums[([t as u32, 0, 0])[0].wrapping_add(_e80) as usize];
                                    let _e84 = joined(_e77, _e83);
                                    m.shared_sums[([t as u32, 0, 0])[0] as usize] = _e84;
                                }
                            }
                        }
                    }
                    let _e85 = reach_v5;
                    reach_v5 = (_e85 / 2u32);
                }
                for t in 0..64 {
                    let sum_e90 = m.shared_sums[0];
                    let mut local_v6: bool;
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        local_v6 = ((sum_e90).mass > 0.0f32);
                    } else {
                        local_v6 = false;
                    }
                    let _e100 = local_v6;
                    if _e100 {
                        let net_e106 = (dot((sum_e90).residual, (sum_e90).residual).sqrt() / (sum_e90).mass);
                        { let old = <u32>::load(m.control, 9); let new = old.max(net_e106.to_bits()); Stored::store(new, m.control, 9); old };
                        { let old = <u32>::load(m.control, 10); let new = old.max(((sum_e90).lengths / (sum_e90).mass).to_bits()); Stored::store(new, m.control, 10); old };
                    }
                }
            }
        }
        let _e118 = b_v0;
        b_v0 = _e118.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let blocks = bound.read(0);
    let sums = bound.read(1);
    let mut control = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        blocks: &blocks,
        sums: &sums,
        control: &mut control,
        shared_sums: [BlockSum::ZERO; 64],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [BlockSum::ZERO; 64];
        main(&mut m, group as u32);
    }
}
}
