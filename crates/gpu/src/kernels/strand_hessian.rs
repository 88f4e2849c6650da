// Written from `shader/elements/strand_hessian.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "strand_hessian",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/blocks.wgsl"),
        include_str!("../../shader/shared/strand.wgsl"),
        include_str!("../../shader/elements/strand_hessian.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const TINY: f32 = 1e-18f32;
pub const MIN_RATIO: f32 = 0.05f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ElementParams {
    pub elements: u32,
    pub first_block: u32,
    pub absolute: u32,
    pub rate: f32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::strand_hessian::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Strand {
    pub nodes: [u32; 3],
    pub rest: f32,
    pub inverse_lengths: [f32; 2],
    pub stiffness: f32,
    pub damping: f32,
}

impl Strand {
    const ZERO: Self = Self {
        nodes: [0u32; 3],
        rest: 0.0f32,
        inverse_lengths: [0.0f32; 2],
        stiffness: 0.0f32,
        damping: 0.0f32,
    };
}

impl Stored for Strand {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            nodes: <[u32; 3]>::load(words, at + 0),
            rest: <f32>::load(words, at + 3),
            inverse_lengths: <[f32; 2]>::load(words, at + 4),
            stiffness: <f32>::load(words, at + 6),
            damping: <f32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.nodes.store(words, at + 0);
        self.rest.store(words, at + 3);
        self.inverse_lengths.store(words, at + 4);
        self.stiffness.store(words, at + 6);
        self.damping.store(words, at + 7);
    }
}

#[derive(Clone, Copy)]
pub struct Curvature {
    pub along: [f32; 3],
    pub axial: f32,
    pub across: f32,
}

impl Curvature {
    const ZERO: Self = Self {
        along: [0.0f32; 3],
        axial: 0.0f32,
        across: 0.0f32,
    };
}

impl Stored for Curvature {
    const WORDS: usize = 5;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            along: <[f32; 3]>::load(words, at + 0),
            axial: <f32>::load(words, at + 3),
            across: <f32>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.along.store(words, at + 0);
        self.axial.store(words, at + 3);
        self.across.store(words, at + 4);
    }
}

struct Memory<'a> {
    params: ElementParams,
    strands: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    blocks: &'a mut [u32],
    curvatures: &'a mut [u32],
}

pub fn way(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e14 = m.params.quantum;
    return zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e14));
}

pub fn moved(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e13 = <[i32; 4]>::load(m.start, 4 * (b_a1 as usize));
    let _e17 = <[i32; 4]>::load(m.start, 4 * (a_a0 as usize));
    let _e24 = m.params.quantum;
    return zip(zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)), zip(swizzle(_e13, [0, 1, 2]), swizzle(_e17, [0, 1, 2]), |x, y| x.wrapping_sub(y)), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e24));
}

pub fn filtered(m: &mut Memory<'_>, curvature_a0: f32) -> f32 {
    let _e6 = m.params.absolute;
    return (if (_e6 == 1u32) { curvature_a0.abs() } else { curvature_a0.max(0.0f32) });
}

pub fn put(m: &mut Memory<'_>, block_a0: u32, a_a1: [f32; 3], b_a2: [f32; 3], c_a3: [f32; 3]) {
    let mut k_v0: u32 = 0u32;
    let _e7 = m.params.first_block;
    let at_e9 = 9u32.wrapping_mul(_e7.wrapping_add(block_a0));
    'l0: loop {
        'c0: {
            let _e12 = k_v0;
            if (_e12 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e16 = k_v0;
                let _e19 = k_v0;
                Stored::store((a_a1)[_e19 as usize], m.blocks, 1 * (at_e9.wrapping_add(_e16) as usize));
                let _e24 = k_v0;
                let _e27 = k_v0;
                Stored::store((b_a2)[_e27 as usize], m.blocks, 1 * (at_e9.wrapping_add(3u32).wrapping_add(_e24) as usize));
                let _e32 = k_v0;
                let _e35 = k_v0;
                Stored::store((c_a3)[_e35 as usize], m.blocks, 1 * (at_e9.wrapping_add(6u32).wrapping_add(_e32) as usize));
            }
        }
        let _e37 = k_v0;
        k_v0 = _e37.wrapping_add(1u32);
    }
}

pub fn is_edge(strand_a0: Strand) -> bool {
    return (((strand_a0).nodes)[0] == ((strand_a0).nodes)[1]);
}

pub fn jump_of(strand_a0: Strand, first_a1: [f32; 3], second_a2: [f32; 3]) -> [f32; 3] {
    return zip(second_a2.map(|x| (x * ((strand_a0).inverse_lengths)[1])), first_a1.map(|x| (x * ((strand_a0).inverse_lengths)[0])), |x, y| (x - y));
}

pub fn along_of(strand_a0: Strand, w_a1: [f32; 3], size_a2: f32) -> [f32; 3] {
    if (size_a2 > 0.0f32) {
        return zip(w_a1, [size_a2; 3], |x, y| (x / y));
    }
    let _e7 = is_edge(strand_a0);
    let _e10 = (if _e7 { 1.0f32 } else { 0.0f32 });
    return [_e10, 0.0f32, 0.0f32];
}

pub fn weights_of(strand_a0: Strand) -> [f32; 3] {
    let a_e2 = ((strand_a0).inverse_lengths)[0];
    let c_e4 = ((strand_a0).inverse_lengths)[1];
    let _e6 = (-(a_e2 + c_e4));
    return [a_e2, _e6, c_e4];
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut e_v0: u32;
    e_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = e_v0;
            let _e6 = m.params.elements;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = e_v0;
                let strand_e11 = <Strand>::load(m.strands, 8 * (_e9 as usize));
                let n_e12 = (strand_e11).nodes;
                let _e15 = way(m, (n_e12)[0], (n_e12)[1]);
                let _e18 = way(m, (n_e12)[1], (n_e12)[2]);
                let w_e19 = jump_of(strand_e11, _e15, _e18);
                let size_e20 = dot(w_e19, w_e19).sqrt();
                let along_e21 = along_of(strand_e11, w_e19, size_e20);
                let mut axial_v1: f32;
                axial_v1 = 1.0f32;
                let mut across_v2: f32;
                across_v2 = 1.0f32;
                if ((strand_e11).rest > 0.0f32) {
                    across_v2 = (1.0f32 - ((strand_e11).rest / size_e20.max((0.05f32 * (strand_e11).rest))));
                }
                let mut local_v3: bool;
                if ((strand_e11).damping > 0.0f32) {
                    let _e44 = m.params.rate;
                    local_v3 = (_e44 > 0.0f32);
                } else {
                    local_v3 = false;
                }
                let _e48 = local_v3;
                if _e48 {
                    let _e52 = m.params.rate;
                    let factor_e53 = ((strand_e11).damping * _e52);
                    let _e54 = is_edge(strand_e11);
                    if _e54 {
                        let _e57 = moved(m, (n_e12)[0], (n_e12)[1]);
                        let _e60 = moved(m, (n_e12)[1], (n_e12)[2]);
                        let turned_e61 = jump_of(strand_e11, _e57, _e60);
                        let strain_e68 = ((0.5f32 * factor_e53) * dot(turned_e61, zip(w_e19.map(|x| (2.0f32 * x)), turned_e61, |x, y| (x - y))));
                        let _e69 = axial_v1;
                        axial_v1 = (_e69 + (((factor_e53 * size_e20) * size_e20) + strain_e68));
                        let _e74 = across_v2;
                        across_v2 = (_e74 + strain_e68);
                    } else {
                        let _e76 = axial_v1;
                        axial_v1 = (_e76 + factor_e53);
                        let _e78 = across_v2;
                        across_v2 = (_e78 + factor_e53);
                    }
                }
                let _e81 = axial_v1;
                let _e82 = filtered(m, _e81);
                axial_v1 = ((strand_e11).stiffness * _e82);
                let _e85 = across_v2;
                let _e86 = filtered(m, _e85);
                across_v2 = ((strand_e11).stiffness * _e86);
                let _e89 = e_v0;
                let _e91 = (along_e21)[0];
                let _e92 = (along_e21)[1];
                let _e93 = (along_e21)[2];
                let _e94 = [_e91, _e92, _e93];
                let _e95 = axial_v1;
                let _e96 = across_v2;
                let _e97 = (_e95 - _e96);
                let _e98 = across_v2;
                Stored::store(Curvature { along: _e94, axial: _e97, across: _e98 }, m.curvatures, 5 * (_e89 as usize));
                let weights_e100 = weights_of(strand_e11);
                let _e102 = e_v0;
                let mut block_v4: u32;
                block_v4 = 3u32.wrapping_mul(_e102);
                let mut a_v5: u32;
                a_v5 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e107 = a_v5;
                        if (_e107 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e110 = a_v5;
                            let mut b_v6: u32;
                            b_v6 = _e110.wrapping_add(1u32);
                            'l2: loop {
                                'c2: {
                                    let _e114 = b_v6;
                                    if (_e114 < 3u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e117 = a_v5;
                                        let _e119 = b_v6;
                                        let weight_e121 = ((weights_e100)[_e117 as usize] * (weights_e100)[_e119 as usize]);
                                        let _e122 = across_v2;
                                        let across_block_e123 = (weight_e121 * _e122);
                                        let _e124 = axial_v1;
                                        let _e125 = across_v2;
                                        let shift_e128 = along_e21.map(|x| (x * (weight_e121 * (_e124 - _e125))));
                                        let _e129 = block_v4;
                                        put(m, _e129, zip(shift_e128.map(|x| (x * (along_e21)[0])), [across_block_e123, 0.0f32, 0.0f32], |x, y| (x + y)), zip(shift_e128.map(|x| (x * (along_e21)[1])), [0.0f32, across_block_e123, 0.0f32], |x, y| (x + y)), zip(shift_e128.map(|x| (x * (along_e21)[2])), [0.0f32, 0.0f32, across_block_e123], |x, y| (x + y)));
                                        let _e148 = block_v4;
                                        block_v4 = _e148.wrapping_add(1u32);
                                    }
                                }
                                let _e151 = b_v6;
                                b_v6 = _e151.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e154 = a_v5;
                    a_v5 = _e154.wrapping_add(1u32);
                }
            }
        }
        let _e157 = e_v0;
        e_v0 = _e157.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let strands = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut blocks = bound.write(3);
    let mut curvatures = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        strands: &strands,
        positions: &positions,
        start: &start,
        blocks: &mut blocks,
        curvatures: &mut curvatures,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
