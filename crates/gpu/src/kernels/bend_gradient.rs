// Written from `shader/elements/bend_gradient.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "bend_gradient",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/gradients.wgsl"),
        include_str!("../../shader/shared/normal.wgsl"),
        include_str!("../../shader/elements/bend_gradient.wgsl"),
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
pub struct GradientParams {
    pub elements: u32,
    pub first: u32,
    pub rate: f32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::bend_gradient::*;
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
    params: GradientParams,
    bends: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    gradients: &'a mut [u32],
}

pub fn way(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e14 = m.params.quantum;
    return zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e14));
}

pub fn put(m: &mut Memory<'_>, entry_a0: u32, gradient_a1: [f32; 3]) {
    let _e5 = m.params.first;
    let at_e7 = 3u32.wrapping_mul(_e5.wrapping_add(entry_a0));
    Stored::store((gradient_a1)[0], m.gradients, 1 * (at_e7 as usize));
    Stored::store((gradient_a1)[1], m.gradients, 1 * (at_e7.wrapping_add(1u32) as usize));
    Stored::store((gradient_a1)[2], m.gradients, 1 * (at_e7.wrapping_add(2u32) as usize));
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
                let mut ways_v2: [[f32; 3]; 6];
                ways_v2 = [[0.0f32; 3]; 6];
                let mut p_v3: u32;
                p_v3 = 1u32;
                'l1: loop {
                    'c1: {
                        let _e17 = p_v3;
                        if (_e17 < 6u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e21 = p_v3;
                            let _e23 = bend_v1.nodes[_e21 as usize];
                            if (_e23 != 4294967295u32) {
                                let _e26 = p_v3;
                                let _e30 = bend_v1.nodes[0];
                                let _e32 = p_v3;
                                let _e34 = bend_v1.nodes[_e32 as usize];
                                let _e35 = way(m, _e30, _e34);
                                ways_v2[_e26 as usize] = _e35;
                            }
                        }
                    }
                    let _e36 = p_v3;
                    p_v3 = _e36.wrapping_add(1u32);
                }
                let g_e40 = bend_v1.gradients;
                let _e42 = ways_v2[1];
                let _e46 = ways_v2[2];
                let f1_e49 = zip(_e42.map(|x| (x * (g_e40)[0])), _e46.map(|x| (x * (g_e40)[2])), |x, y| (x + y));
                let _e51 = ways_v2[1];
                let _e55 = ways_v2[2];
                let f2_e58 = zip(_e51.map(|x| (x * (g_e40)[1])), _e55.map(|x| (x * (g_e40)[3])), |x, y| (x + y));
                let _e61 = bend_v1.crushed;
                let normal_e62 = normal_of(cross(f1_e49, f2_e58), _e61);
                let _e63 = bend_v1;
                let _e64 = factors_of(_e63);
                let mut factors_v4: [f32; 18];
                factors_v4 = _e64;
                let mut residuals_v5: [[f32; 3]; 3];
                residuals_v5 = [[0.0f32; 3]; 3];
                let mut i_v6: u32;
                i_v6 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e70 = i_v6;
                        if (_e70 < 3u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e76 = i_v6;
                            let _e81 = bend_v1.rest[3u32.wrapping_mul(_e76).wrapping_add(2u32) as usize];
                            let mut sum_v7: [f32; 3];
                            sum_v7 = (normal_e62).m_.map(|x| (x * ((-_e81) * (normal_e62).scale)));
                            let mut p_v8: u32;
                            p_v8 = 1u32;
                            'l3: loop {
                                'c3: {
                                    let _e89 = p_v8;
                                    if (_e89 < 6u32) {
                                    } else {
                                        break 'l3;
                                    }
                                    {
                                        let _e92 = sum_v7;
                                        let _e93 = p_v8;
                                        let _e95 = ways_v2[_e93 as usize];
                                        let _e97 = i_v6;
                                        let _e99 = p_v8;
                                        let _e102 = factors_v4[6u32.wrapping_mul(_e97).wrapping_add(_e99) as usize];
                                        sum_v7 = zip(_e92, _e95.map(|x| (x * _e102)), |x, y| (x + y));
                                    }
                                }
                                let _e105 = p_v8;
                                p_v8 = _e105.wrapping_add(1u32);
                            }
                            let _e108 = i_v6;
                            let _e110 = sum_v7;
                            residuals_v5[_e108 as usize] = _e110;
                        }
                    }
                    let _e111 = i_v6;
                    i_v6 = _e111.wrapping_add(1u32);
                }
                let mut stresses_v9: [[f32; 3]; 3];
                stresses_v9 = [[0.0f32; 3]; 3];
                let mut turning_v10: [f32; 3];
                turning_v10 = [0.0f32; 3];
                let mut i_v11: u32;
                i_v11 = 0u32;
                'l4: loop {
                    'c4: {
                        let _e121 = i_v11;
                        if (_e121 < 3u32) {
                        } else {
                            break 'l4;
                        }
                        {
                            let _e124 = i_v11;
                            let _e127 = residuals_v5[0];
                            let _e130 = i_v11;
                            let _e133 = bend_v1.gram[3u32.wrapping_mul(_e130) as usize];
                            let _e136 = residuals_v5[1];
                            let _e139 = i_v11;
                            let _e144 = bend_v1.gram[3u32.wrapping_mul(_e139).wrapping_add(1u32) as usize];
                            let _e148 = residuals_v5[2];
                            let _e151 = i_v11;
                            let _e156 = bend_v1.gram[3u32.wrapping_mul(_e151).wrapping_add(2u32) as usize];
                            stresses_v9[_e124 as usize] = zip(zip(_e127.map(|x| (x * _e133)), _e136.map(|x| (x * _e144)), |x, y| (x + y)), _e148.map(|x| (x * _e156)), |x, y| (x + y));
                            let _e159 = turning_v10;
                            let _e160 = i_v11;
                            let _e162 = stresses_v9[_e160 as usize];
                            let _e165 = i_v11;
                            let _e170 = bend_v1.rest[3u32.wrapping_mul(_e165).wrapping_add(2u32) as usize];
                            turning_v10 = zip(_e159, _e162.map(|x| (x * _e170)), |x, y| (x + y));
                        }
                    }
                    let _e173 = i_v11;
                    i_v11 = _e173.wrapping_add(1u32);
                }
                let _e176 = turning_v10;
                let _e179 = turning_v10;
                let across_e186 = zip(_e176, (normal_e62).m_.map(|x| (x * (dot((normal_e62).m_, _e179) / (normal_e62).squared))), |x, y| (x - y)).map(|x| (x * (normal_e62).scale));
                let by_f1_e187 = cross(f2_e58, across_e186);
                let by_f2_e188 = cross(across_e186, f1_e49);
                let mut rest_v12: [f32; 3];
                rest_v12 = [0.0f32; 3];
                let mut p_v13: u32;
                p_v13 = 1u32;
                'l5: loop {
                    'c5: {
                        let _e194 = p_v13;
                        if (_e194 < 6u32) {
                        } else {
                            break 'l5;
                        }
                        {
                            let _e198 = stresses_v9[0];
                            let _e199 = p_v13;
                            let _e201 = factors_v4[_e199 as usize];
                            let _e204 = stresses_v9[1];
                            let _e206 = p_v13;
                            let _e209 = factors_v4[6u32.wrapping_add(_e206) as usize];
                            let _e213 = stresses_v9[2];
                            let _e215 = p_v13;
                            let _e218 = factors_v4[12u32.wrapping_add(_e215) as usize];
                            let mut sum_v14: [f32; 3];
                            sum_v14 = zip(zip(_e198.map(|x| (x * _e201)), _e204.map(|x| (x * _e209)), |x, y| (x + y)), _e213.map(|x| (x * _e218)), |x, y| (x + y));
                            let _e222 = p_v13;
                            if (_e222 < 3u32) {
                                let _e225 = sum_v14;
                                let _e228 = p_v13;
                                let _e233 = bend_v1.gradients[2u32.wrapping_mul(_e228).wrapping_sub(2u32) as usize];
                                let _e237 = p_v13;
                                let _e242 = bend_v1.gradients[2u32.wrapping_mul(_e237).wrapping_sub(1u32) as usize];
                                sum_v14 = zip(_e225, zip(by_f1_e187.map(|x| (x * _e233)), by_f2_e188.map(|x| (x * _e242)), |x, y| (x + y)), |x, y| (x - y));
                            }
                            let _e247 = e_v0;
                            let _e249 = p_v13;
                            let _e251 = sum_v14;
                            put(m, 6u32.wrapping_mul(_e247).wrapping_add(_e249), _e251);
                            let _e252 = rest_v12;
                            let _e253 = sum_v14;
                            rest_v12 = zip(_e252, _e253, |x, y| (x + y));
                        }
                    }
                    let _e255 = p_v13;
                    p_v13 = _e255.wrapping_add(1u32);
                }
                let _e259 = e_v0;
                let _e261 = rest_v12;
                put(m, 6u32.wrapping_mul(_e259), _e261.map(|x| (-x)));
            }
        }
        let _e263 = e_v0;
        e_v0 = _e263.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let bends = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut gradients = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        bends: &bends,
        positions: &positions,
        start: &start,
        gradients: &mut gradients,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
