// Written from `shader/elements/bend_hessian.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "bend_hessian",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/blocks.wgsl"),
        include_str!("../../shader/shared/normal.wgsl"),
        include_str!("../../shader/elements/bend_hessian.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
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
use crate::kernels::bend_hessian::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Bend {
    pub nodes: [u32; 6],
    pub jumps: [f32; 18],
    pub gram: [f32; 9],
    pub gradients: [f32; 4],
    pub rest: [f32; 9],
    pub crushed: f32,
    pub padding: u32,
}

impl Bend {
    const ZERO: Self = Self {
        nodes: [0u32; 6],
        jumps: [0.0f32; 18],
        gram: [0.0f32; 9],
        gradients: [0.0f32; 4],
        rest: [0.0f32; 9],
        crushed: 0.0f32,
        padding: 0u32,
    };
}

impl Stored for Bend {
    const WORDS: usize = 48;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            nodes: <[u32; 6]>::load(words, at + 0),
            jumps: <[f32; 18]>::load(words, at + 6),
            gram: <[f32; 9]>::load(words, at + 24),
            gradients: <[f32; 4]>::load(words, at + 33),
            rest: <[f32; 9]>::load(words, at + 37),
            crushed: <f32>::load(words, at + 46),
            padding: <u32>::load(words, at + 47),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.nodes.store(words, at + 0);
        self.jumps.store(words, at + 6);
        self.gram.store(words, at + 24);
        self.gradients.store(words, at + 33);
        self.rest.store(words, at + 37);
        self.crushed.store(words, at + 46);
        self.padding.store(words, at + 47);
    }
}

#[derive(Clone, Copy)]
pub struct Normal {
    pub m_: [f32; 3],
    pub squared: f32,
    pub scale: f32,
}

impl Normal {
    const ZERO: Self = Self {
        m_: [0.0f32; 3],
        squared: 0.0f32,
        scale: 0.0f32,
    };
}

impl Stored for Normal {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            m_: <[f32; 3]>::load(words, at + 0),
            squared: <f32>::load(words, at + 3),
            scale: <f32>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.m_.store(words, at + 0);
        self.squared.store(words, at + 3);
        self.scale.store(words, at + 4);
    }
}

struct Memory<'a> {
    params: ElementParams,
    bends: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    blocks: &'a mut [u32],
}

pub fn way(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e14 = m.params.quantum;
    return zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e14));
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

pub fn normal_of(m_a0: [f32; 3], crushed_a1: f32) -> Normal {
    let mut normal_v0: Normal = Normal::ZERO;
    normal_v0.m_ = m_a0;
    normal_v0.squared = (dot(m_a0, m_a0) + (crushed_a1 * crushed_a1));
    let _e13 = normal_v0.squared;
    normal_v0.scale = ((1.0f32 + (crushed_a1 * crushed_a1)) / _e13).sqrt();
    let _e16 = normal_v0;
    return _e16;
}

pub fn factors_of(bend_a0: Bend) -> [f32; 18] {
    let mut edge_v1: u32 = 0u32;
    let mut factors_v0: [f32; 18];
    factors_v0 = (bend_a0).jumps;
    'l0: loop {
        'c0: {
            let _e5 = edge_v1;
            if (_e5 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e10 = edge_v1;
                let along_e12 = ((bend_a0).rest)[3u32.wrapping_mul(_e10) as usize];
                let _e15 = edge_v1;
                let beside_e19 = ((bend_a0).rest)[3u32.wrapping_mul(_e15).wrapping_add(1u32) as usize];
                let first_e26 = ((along_e12 * ((bend_a0).gradients)[0]) + (beside_e19 * ((bend_a0).gradients)[1]));
                let second_e33 = ((along_e12 * ((bend_a0).gradients)[2]) + (beside_e19 * ((bend_a0).gradients)[3]));
                let _e35 = edge_v1;
                let _e38 = factors_v0[6u32.wrapping_mul(_e35) as usize];
                factors_v0[6u32.wrapping_mul(_e35) as usize] = (_e38 + (first_e26 + second_e33));
                let _e42 = edge_v1;
                let _e47 = factors_v0[6u32.wrapping_mul(_e42).wrapping_add(1u32) as usize];
                factors_v0[6u32.wrapping_mul(_e42).wrapping_add(1u32) as usize] = (_e47 - first_e26);
                let _e50 = edge_v1;
                let _e55 = factors_v0[6u32.wrapping_mul(_e50).wrapping_add(2u32) as usize];
                factors_v0[6u32.wrapping_mul(_e50).wrapping_add(2u32) as usize] = (_e55 - second_e33);
            }
        }
        let _e57 = edge_v1;
        edge_v1 = _e57.wrapping_add(1u32);
    }
    let _e60 = factors_v0;
    return _e60;
}

pub fn cross_matrix(a_a0: [f32; 3]) -> [[f32; 3]; 3] {
    let _e1 = (a_a0)[2];
    let _e3 = (-(a_a0)[1]);
    let _e5 = [0.0f32, _e1, _e3];
    let _e7 = (-(a_a0)[2]);
    let _e8 = (a_a0)[0];
    let _e10 = [_e7, 0.0f32, _e8];
    let _e11 = (a_a0)[1];
    let _e13 = (-(a_a0)[0]);
    let _e15 = [_e11, _e13, 0.0f32];
    return [_e5, _e10, _e15];
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
                let _e11 = <Bend>::load(m.bends, 48 * (_e9 as usize));
                let mut bend_v1: Bend;
                bend_v1 = _e11;
                let _e15 = bend_v1.nodes[0];
                let _e18 = bend_v1.nodes[1];
                let e1_e19 = way(m, _e15, _e18);
                let _e22 = bend_v1.nodes[0];
                let _e25 = bend_v1.nodes[2];
                let e2_e26 = way(m, _e22, _e25);
                let _e29 = bend_v1.gradients[0];
                let _e33 = bend_v1.gradients[2];
                let f1_e35 = zip(e1_e19.map(|x| (x * _e29)), e2_e26.map(|x| (x * _e33)), |x, y| (x + y));
                let _e38 = bend_v1.gradients[1];
                let _e42 = bend_v1.gradients[3];
                let f2_e44 = zip(e1_e19.map(|x| (x * _e38)), e2_e26.map(|x| (x * _e42)), |x, y| (x + y));
                let _e47 = bend_v1.crushed;
                let normal_e48 = normal_of(cross(f1_e35, f2_e44), _e47);
                let m_e49 = (normal_e48).m_;
                let squared_e50 = (normal_e48).squared;
                let scale_e51 = (normal_e48).scale;
                let mut across_v2: [[f32; 3]; 3];
                across_v2 = [[0.0f32; 3]; 3];
                let mut k_v3: u32;
                k_v3 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e56 = k_v3;
                        if (_e56 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e59 = k_v3;
                            let mut column_v4: [f32; 3];
                            column_v4 = m_e49.map(|x| (x * ((-(m_e49)[_e59 as usize]) / squared_e50)));
                            let _e65 = k_v3;
                            let _e67 = column_v4[_e65 as usize];
                            column_v4[_e65 as usize] = (_e67 + 1.0f32);
                            let _e70 = k_v3;
                            let _e72 = column_v4;
                            across_v2[_e70 as usize] = _e72.map(|x| (x * scale_e51));
                        }
                    }
                    let _e74 = k_v3;
                    k_v3 = _e74.wrapping_add(1u32);
                }
                let _e77 = across_v2;
                let _e79 = cross_matrix(f2_e44.map(|x| (-x)));
                let by_f1_e80 = product(_e77, _e79);
                let _e81 = across_v2;
                let _e82 = cross_matrix(f1_e35);
                let by_f2_e83 = product(_e81, _e82);
                let mut turns_v5: [[[f32; 3]; 3]; 3];
                turns_v5 = [[[0.0f32; 3]; 3]; 3];
                let _e89 = bend_v1.gradients[0];
                let _e93 = bend_v1.gradients[1];
                turns_v5[1] = zip(by_f1_e80.map(|column| column.map(|x| (x * _e89))), by_f2_e83.map(|column| column.map(|x| (x * _e93))), |a, b| zip(a, b, |x, y| (x + y)));
                let _e99 = bend_v1.gradients[2];
                let _e103 = bend_v1.gradients[3];
                turns_v5[2] = zip(by_f1_e80.map(|column| column.map(|x| (x * _e99))), by_f2_e83.map(|column| column.map(|x| (x * _e103))), |a, b| zip(a, b, |x, y| (x + y)));
                let _e108 = turns_v5[1];
                let _e110 = turns_v5[2];
                turns_v5[0] = zip(_e108, _e110, |a, b| zip(a, b, |x, y| (x + y))).map(|column| column.map(|x| (x * (-1.0f32))));
                let _e114 = bend_v1;
                let _e115 = factors_of(_e114);
                let mut factors_v6: [f32; 18];
                factors_v6 = _e115;
                let _e118 = e_v0;
                let mut block_v7: u32;
                block_v7 = 15u32.wrapping_mul(_e118);
                let mut p_v8: u32;
                p_v8 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e123 = p_v8;
                        if (_e123 < 6u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e126 = p_v8;
                            let mut q_v9: u32;
                            q_v9 = _e126.wrapping_add(1u32);
                            'l3: loop {
                                'c3: {
                                    let _e130 = q_v9;
                                    if (_e130 < 6u32) {
                                    } else {
                                        break 'l3;
                                    }
                                    {
                                        let mut both_v10: f32;
                                        both_v10 = 0.0f32;
                                        let mut left_v11: f32;
                                        left_v11 = 0.0f32;
                                        let mut right_v12: f32;
                                        right_v12 = 0.0f32;
                                        let mut none_v13: f32;
                                        none_v13 = 0.0f32;
                                        let mut i_v14: u32;
                                        i_v14 = 0u32;
                                        'l4: loop {
                                            'c4: {
                                                let _e143 = i_v14;
                                                if (_e143 < 3u32) {
                                                } else {
                                                    break 'l4;
                                                }
                                                {
                                                    let mut j_v15: u32;
                                                    j_v15 = 0u32;
                                                    'l5: loop {
                                                        'c5: {
                                                            let _e148 = j_v15;
                                                            if (_e148 < 3u32) {
                                                            } else {
                                                                break 'l5;
                                                            }
                                                            {
                                                                let _e153 = i_v14;
                                                                let _e155 = j_v15;
                                                                let g_e158 = bend_v1.gram[3u32.wrapping_mul(_e153).wrapping_add(_e155) as usize];
                                                                let _e161 = i_v14;
                                                                let ci_e166 = bend_v1.rest[3u32.wrapping_mul(_e161).wrapping_add(2u32) as usize];
                                                                let _e169 = j_v15;
                                                                let cj_e174 = bend_v1.rest[3u32.wrapping_mul(_e169).wrapping_add(2u32) as usize];
                                                                let _e175 = both_v10;
                                                                let _e177 = i_v14;
                                                                let _e179 = p_v8;
                                                                let _e182 = factors_v6[6u32.wrapping_mul(_e177).wrapping_add(_e179) as usize];
                                                                let _e185 = j_v15;
                                                                let _e187 = q_v9;
                                                                let _e190 = factors_v6[6u32.wrapping_mul(_e185).wrapping_add(_e187) as usize];
                                                                both_v10 = (_e175 + ((g_e158 * _e182) * _e190));
                                                                let _e193 = left_v11;
                                                                let _e195 = i_v14;
                                                                let _e197 = p_v8;
                                                                let _e200 = factors_v6[6u32.wrapping_mul(_e195).wrapping_add(_e197) as usize];
                                                                left_v11 = (_e193 + ((g_e158 * _e200) * cj_e174));
                                                                let _e204 = right_v12;
                                                                let _e207 = j_v15;
                                                                let _e209 = q_v9;
                                                                let _e212 = factors_v6[6u32.wrapping_mul(_e207).wrapping_add(_e209) as usize];
                                                                right_v12 = (_e204 + ((g_e158 * ci_e166) * _e212));
                                                                let _e215 = none_v13;
                                                                none_v13 = (_e215 + ((g_e158 * ci_e166) * cj_e174));
                                                            }
                                                        }
                                                        let _e219 = j_v15;
                                                        j_v15 = _e219.wrapping_add(1u32);
                                                    }
                                                }
                                            }
                                            let _e222 = i_v14;
                                            i_v14 = _e222.wrapping_add(1u32);
                                        }
                                        let _e225 = both_v10;
                                        let _e228 = [_e225, 0.0f32, 0.0f32];
                                        let _e229 = both_v10;
                                        let _e232 = [0.0f32, _e229, 0.0f32];
                                        let _e233 = both_v10;
                                        let _e236 = [0.0f32, 0.0f32, _e233];
                                        let mut sum_v16: [[f32; 3]; 3];
                                        sum_v16 = [_e228, _e232, _e236];
                                        let _e239 = q_v9;
                                        if (_e239 < 3u32) {
                                            let _e242 = sum_v16;
                                            let _e243 = q_v9;
                                            let _e245 = turns_v5[_e243 as usize];
                                            let _e246 = left_v11;
                                            let _e249 = p_v8;
                                            let _e251 = turns_v5[_e249 as usize];
                                            let _e253 = q_v9;
                                            let _e255 = turns_v5[_e253 as usize];
                                            let _e257 = none_v13;
                                            sum_v16 = zip(_e242, zip(_e245.map(|column| column.map(|x| (x * (-_e246)))), product(transpose(_e251), _e255).map(|column| column.map(|x| (x * _e257))), |a, b| zip(a, b, |x, y| (x + y))), |a, b| zip(a, b, |x, y| (x + y)));
                                        }
                                        let _e261 = p_v8;
                                        if (_e261 < 3u32) {
                                            let _e264 = sum_v16;
                                            let _e265 = p_v8;
                                            let _e267 = turns_v5[_e265 as usize];
                                            let _e269 = right_v12;
                                            sum_v16 = zip(_e264, transpose(_e267).map(|column| column.map(|x| (x * (-_e269)))), |a, b| zip(a, b, |x, y| (x + y)));
                                        }
                                        let _e273 = block_v7;
                                        let _e275 = sum_v16[0];
                                        let _e277 = sum_v16[1];
                                        let _e279 = sum_v16[2];
                                        put(m, _e273, _e275, _e277, _e279);
                                        let _e280 = block_v7;
                                        block_v7 = _e280.wrapping_add(1u32);
                                    }
                                }
                                let _e283 = q_v9;
                                q_v9 = _e283.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e286 = p_v8;
                    p_v8 = _e286.wrapping_add(1u32);
                }
            }
        }
        let _e289 = e_v0;
        e_v0 = _e289.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let bends = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut blocks = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        bends: &bends,
        positions: &positions,
        start: &start,
        blocks: &mut blocks,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
