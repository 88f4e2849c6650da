// Written from `shader/elements/tetrahedron_hessian.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "tetrahedron_hessian",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/blocks.wgsl"),
        include_str!("../../shader/shared/strain.wgsl"),
        include_str!("../../shader/shared/solid.wgsl"),
        include_str!("../../shader/shared/eigen.wgsl"),
        include_str!("../../shader/elements/tetrahedron_hessian.wgsl"),
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
pub const ORTHOGONAL: f32 = 3e-7f32;
pub const SVD_SWEEPS: u32 = 8u32;
pub const NEGLIGIBLE: f32 = 1e-8f32;
pub const SWEEPS: u32 = 6u32;
pub const ORDER: u32 = 3u32;

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
use crate::kernels::tetrahedron_hessian::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Tetrahedron {
    pub nodes: [u32; 4],
    pub gradients: [f32; 9],
    pub volume: f32,
    pub lambda: f32,
    pub mu: f32,
    pub law: u32,
    pub viscous_lambda: f32,
    pub viscous_mu: f32,
    pub padding: u32,
}

impl Tetrahedron {
    const ZERO: Self = Self {
        nodes: [0u32; 4],
        gradients: [0.0f32; 9],
        volume: 0.0f32,
        lambda: 0.0f32,
        mu: 0.0f32,
        law: 0u32,
        viscous_lambda: 0.0f32,
        viscous_mu: 0.0f32,
        padding: 0u32,
    };
}

impl Stored for Tetrahedron {
    const WORDS: usize = 20;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            nodes: <[u32; 4]>::load(words, at + 0),
            gradients: <[f32; 9]>::load(words, at + 4),
            volume: <f32>::load(words, at + 13),
            lambda: <f32>::load(words, at + 14),
            mu: <f32>::load(words, at + 15),
            law: <u32>::load(words, at + 16),
            viscous_lambda: <f32>::load(words, at + 17),
            viscous_mu: <f32>::load(words, at + 18),
            padding: <u32>::load(words, at + 19),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.nodes.store(words, at + 0);
        self.gradients.store(words, at + 4);
        self.volume.store(words, at + 13);
        self.lambda.store(words, at + 14);
        self.mu.store(words, at + 15);
        self.law.store(words, at + 16);
        self.viscous_lambda.store(words, at + 17);
        self.viscous_mu.store(words, at + 18);
        self.padding.store(words, at + 19);
    }
}

#[derive(Clone, Copy)]
pub struct Decomposition {
    pub b: [[f32; 3]; 3],
    pub v: [[f32; 3]; 3],
}

impl Decomposition {
    const ZERO: Self = Self {
        b: [[0.0f32; 3]; 3],
        v: [[0.0f32; 3]; 3],
    };
}

impl Stored for Decomposition {
    const WORDS: usize = 24;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            b: <[[f32; 3]; 3]>::load(words, at + 0),
            v: <[[f32; 3]; 3]>::load(words, at + 12),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.b.store(words, at + 0);
        self.v.store(words, at + 12);
    }
}

#[derive(Clone, Copy)]
pub struct Singular {
    pub u: [[f32; 3]; 3],
    pub s: [f32; 3],
    pub v: [[f32; 3]; 3],
}

impl Singular {
    const ZERO: Self = Self {
        u: [[0.0f32; 3]; 3],
        s: [0.0f32; 3],
        v: [[0.0f32; 3]; 3],
    };
}

impl Stored for Singular {
    const WORDS: usize = 28;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            u: <[[f32; 3]; 3]>::load(words, at + 0),
            s: <[f32; 3]>::load(words, at + 12),
            v: <[[f32; 3]; 3]>::load(words, at + 16),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.u.store(words, at + 0);
        self.s.store(words, at + 12);
        self.v.store(words, at + 16);
    }
}

#[derive(Clone, Copy)]
pub struct Curvatures {
    pub scaling: [f32; 9],
    pub flip: [f32; 3],
    pub twist: [f32; 3],
}

impl Curvatures {
    const ZERO: Self = Self {
        scaling: [0.0f32; 9],
        flip: [0.0f32; 3],
        twist: [0.0f32; 3],
    };
}

impl Stored for Curvatures {
    const WORDS: usize = 20;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            scaling: <[f32; 9]>::load(words, at + 0),
            flip: <[f32; 3]>::load(words, at + 12),
            twist: <[f32; 3]>::load(words, at + 16),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.scaling.store(words, at + 0);
        self.flip.store(words, at + 12);
        self.twist.store(words, at + 16);
    }
}

struct Memory<'a> {
    params: ElementParams,
    tetrahedra: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    blocks: &'a mut [u32],
}

pub fn any_normal(u_a0: [f32; 3]) -> [f32; 3] {
    if ((u_a0)[0].abs() < 0.6f32) {
        let _e5 = (u_a0)[2];
        let _e7 = (-(u_a0)[1]);
        let _e9 = [0.0f32, _e5, _e7];
        return normalize(_e9);
    }
    let _e12 = (-(u_a0)[2]);
    let _e13 = (u_a0)[0];
    let _e15 = [_e12, 0.0f32, _e13];
    return normalize(_e15);
}

pub fn way(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e14 = m.params.quantum;
    return zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e14));
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

pub fn columns_of(tet_a0: Tetrahedron, e1_a1: [f32; 3], e2_a2: [f32; 3], e3_a3: [f32; 3]) -> [[f32; 3]; 3] {
    let g_e4 = (tet_a0).gradients;
    let _e12 = zip(zip(e1_a1.map(|x| (x * (g_e4)[0])), e2_a2.map(|x| (x * (g_e4)[3])), |x, y| (x + y)), e3_a3.map(|x| (x * (g_e4)[6])), |x, y| (x + y));
    let _e20 = zip(zip(e1_a1.map(|x| (x * (g_e4)[1])), e2_a2.map(|x| (x * (g_e4)[4])), |x, y| (x + y)), e3_a3.map(|x| (x * (g_e4)[7])), |x, y| (x + y));
    let _e28 = zip(zip(e1_a1.map(|x| (x * (g_e4)[2])), e2_a2.map(|x| (x * (g_e4)[5])), |x, y| (x + y)), e3_a3.map(|x| (x * (g_e4)[8])), |x, y| (x + y));
    return [_e12, _e20, _e28];
}

pub fn deformation_of(m: &mut Memory<'_>, tet_a0: Tetrahedron) -> [[f32; 3]; 3] {
    let n_e1 = (tet_a0).nodes;
    let _e4 = way(m, (n_e1)[0], (n_e1)[1]);
    let _e7 = way(m, (n_e1)[0], (n_e1)[2]);
    let _e10 = way(m, (n_e1)[0], (n_e1)[3]);
    let _e11 = columns_of(tet_a0, _e4, _e7, _e10);
    return _e11;
}

pub fn decompose(f_a0: [[f32; 3]; 3]) -> Decomposition {
    let mut out_v0: Decomposition = Decomposition::ZERO;
    let mut sweep_v1: u32 = 0u32;
    let mut k_v3: u32 = 0u32;
    out_v0.b = f_a0;
    out_v0.v[0] = [1.0f32, 0.0f32, 0.0f32];
    out_v0.v[1] = [0.0f32, 1.0f32, 0.0f32];
    out_v0.v[2] = [0.0f32, 0.0f32, 1.0f32];
    'l0: loop {
        'c0: {
            let _e23 = sweep_v1;
            if (_e23 < 8u32) {
            } else {
                break 'l0;
            }
            {
                let mut pair_v2: u32;
                pair_v2 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e28 = pair_v2;
                        if (_e28 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e31 = pair_v2;
                            let p_e33 = (_e31 / 2u32);
                            let _e35 = pair_v2;
                            let q_e40 = 1u32.wrapping_add((_e35.wrapping_add(1u32) / 2u32));
                            let _e43 = out_v0.b[p_e33 as usize];
                            let _e46 = out_v0.b[p_e33 as usize];
                            let pp_e47 = dot(_e43, _e46);
                            let _e50 = out_v0.b[q_e40 as usize];
                            let _e53 = out_v0.b[q_e40 as usize];
                            let qq_e54 = dot(_e50, _e53);
                            let _e57 = out_v0.b[p_e33 as usize];
                            let _e60 = out_v0.b[q_e40 as usize];
                            let pq_e61 = dot(_e57, _e60);
                            if ((pq_e61 * pq_e61) > ((9.000001e-14f32 * pp_e47) * qq_e54)) {
                                let tau_e70 = ((qq_e54 - pp_e47) / (2.0f32 * pq_e61));
                                let size_e78 = (1.0f32 / (tau_e70.abs() + (1.0f32 + (tau_e70 * tau_e70)).sqrt()));
                                let t_e82 = (if (tau_e70 >= 0.0f32) { size_e78 } else { (-size_e78) });
                                let c_e88 = (1.0f32 / (1.0f32 + (t_e82 * t_e82)).sqrt());
                                let s_e89 = (t_e82 * c_e88);
                                let x_e92 = out_v0.b[p_e33 as usize];
                                let y_e95 = out_v0.b[q_e40 as usize];
                                out_v0.b[p_e33 as usize] = zip(x_e92.map(|x| (c_e88 * x)), y_e95.map(|x| (s_e89 * x)), |x, y| (x - y));
                                out_v0.b[q_e40 as usize] = zip(x_e92.map(|x| (s_e89 * x)), y_e95.map(|x| (c_e88 * x)), |x, y| (x + y));
                                let z_e108 = out_v0.v[p_e33 as usize];
                                let w_e111 = out_v0.v[q_e40 as usize];
                                out_v0.v[p_e33 as usize] = zip(z_e108.map(|x| (c_e88 * x)), w_e111.map(|x| (s_e89 * x)), |x, y| (x - y));
                                out_v0.v[q_e40 as usize] = zip(z_e108.map(|x| (s_e89 * x)), w_e111.map(|x| (c_e88 * x)), |x, y| (x + y));
                            }
                        }
                    }
                    let _e122 = pair_v2;
                    pair_v2 = _e122.wrapping_add(1u32);
                }
            }
        }
        let _e125 = sweep_v1;
        sweep_v1 = _e125.wrapping_add(1u32);
    }
    'l2: loop {
        'c2: {
            let _e130 = k_v3;
            if (_e130 < 3u32) {
            } else {
                break 'l2;
            }
            {
                let _e133 = k_v3;
                let p_e135 = (_e133 % 2u32);
                let q_e137 = p_e135.wrapping_add(1u32);
                let _e140 = out_v0.b[p_e135 as usize];
                let _e143 = out_v0.b[p_e135 as usize];
                let _e147 = out_v0.b[q_e137 as usize];
                let _e150 = out_v0.b[q_e137 as usize];
                if (dot(_e140, _e143) < dot(_e147, _e150)) {
                    let x_e155 = out_v0.b[p_e135 as usize];
                    let _e160 = out_v0.b[q_e137 as usize];
                    out_v0.b[p_e135 as usize] = _e160;
                    out_v0.b[q_e137 as usize] = x_e155.map(|x| (-x));
                    let z_e166 = out_v0.v[p_e135 as usize];
                    let _e171 = out_v0.v[q_e137 as usize];
                    out_v0.v[p_e135 as usize] = _e171;
                    out_v0.v[q_e137 as usize] = z_e166.map(|x| (-x));
                }
            }
        }
        let _e175 = k_v3;
        k_v3 = _e175.wrapping_add(1u32);
    }
    let _e178 = out_v0;
    return _e178;
}

pub fn singular_of(f_a0: [[f32; 3]; 3]) -> Singular {
    let mut u1_v0: [f32; 3] = [1.0f32, 0.0f32, 0.0f32];
    let mut out_v3: Singular = Singular::ZERO;
    let svd_e1 = decompose(f_a0);
    let _e3 = ((svd_e1).b)[0];
    let s1_e4 = dot(_e3, _e3).sqrt();
    if (s1_e4 > 1e-18f32) {
        u1_v0 = zip(((svd_e1).b)[0], [s1_e4; 3], |x, y| (x / y));
    }
    let _e18 = u1_v0;
    let _e19 = u1_v0;
    let rest_e24 = zip(((svd_e1).b)[1], _e18.map(|x| (x * dot(_e19, ((svd_e1).b)[1]))), |x, y| (x - y));
    let s2_e25 = dot(rest_e24, rest_e24).sqrt();
    let _e26 = u1_v0;
    let _e27 = any_normal(_e26);
    let mut u2_v1: [f32; 3];
    u2_v1 = _e27;
    let mut local_v2: bool;
    if (s2_e25 > (1e-6f32 * s1_e4)) {
        local_v2 = (s2_e25 > 1e-18f32);
    } else {
        local_v2 = false;
    }
    let _e37 = local_v2;
    if _e37 {
        u2_v1 = zip(rest_e24, [s2_e25; 3], |x, y| (x / y));
    }
    let _e40 = u1_v0;
    let _e41 = u2_v1;
    let u3_e42 = cross(_e40, _e41);
    let _e45 = u1_v0;
    let _e46 = u2_v1;
    out_v3.u = [_e45, _e46, u3_e42];
    let _e49 = u2_v1;
    let _e52 = dot(_e49, ((svd_e1).b)[1]);
    let _e55 = dot(u3_e42, ((svd_e1).b)[2]);
    out_v3.s = [s1_e4, _e52, _e55];
    out_v3.v = (svd_e1).v;
    let _e59 = out_v3;
    return _e59;
}

pub fn curvatures_of(tet_a0: Tetrahedron, singular_a1: [f32; 3]) -> Curvatures {
    let mut out_v1: Curvatures = Curvatures::ZERO;
    let mut i_v2: u32 = 0u32;
    let mut i_v4: u32 = 0u32;
    let mut s_v0: [f32; 3];
    s_v0 = singular_a1;
    if ((tet_a0).law == 0u32) {
        let _e7 = s_v0;
        let _e13 = s_v0;
        let strain_e17 = zip(zip(_e7, [1.0f32; 3], |x, y| (x - y)).map(|x| (0.5f32 * x)), zip(_e13, [1.0f32; 3], |x, y| (x + y)), |x, y| (x * y));
        let pressure_e24 = ((tet_a0).lambda * (((strain_e17)[0] + (strain_e17)[1]) + (strain_e17)[2]));
        'l0: loop {
            'c0: {
                let _e27 = i_v2;
                if (_e27 < 3u32) {
                } else {
                    break 'l0;
                }
                {
                    let mut j_v3: u32;
                    j_v3 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e32 = j_v3;
                            if (_e32 < 3u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e37 = i_v2;
                                let _e39 = j_v3;
                                let _e43 = i_v2;
                                let _e45 = s_v0[_e43 as usize];
                                let _e47 = j_v3;
                                let _e49 = s_v0[_e47 as usize];
                                out_v1.scaling[3u32.wrapping_mul(_e37).wrapping_add(_e39) as usize] = (((tet_a0).lambda * _e45) * _e49);
                            }
                        }
                        let _e51 = j_v3;
                        j_v3 = _e51.wrapping_add(1u32);
                    }
                    let _e56 = i_v2;
                    let _e59 = out_v1.scaling[4u32.wrapping_mul(_e56) as usize];
                    let _e61 = i_v2;
                    let _e63 = s_v0[_e61 as usize];
                    let _e66 = i_v2;
                    let _e68 = s_v0[_e66 as usize];
                    out_v1.scaling[4u32.wrapping_mul(_e56) as usize] = (_e59 + (((tet_a0).mu * (((3.0f32 * _e63) * _e68) - 1.0f32)) + pressure_e24));
                    let _e75 = i_v2;
                    let a_e81 = s_v0[(_e75.wrapping_add(1u32) % 3u32) as usize];
                    let _e82 = i_v2;
                    let b_e88 = s_v0[(_e82.wrapping_add(2u32) % 3u32) as usize];
                    let _e90 = i_v2;
                    out_v1.flip[_e90 as usize] = (((tet_a0).mu * ((((a_e81 * a_e81) + (a_e81 * b_e88)) + (b_e88 * b_e88)) - 1.0f32)) + pressure_e24);
                    let _e103 = i_v2;
                    out_v1.twist[_e103 as usize] = (((tet_a0).mu * ((((a_e81 * a_e81) - (a_e81 * b_e88)) + (b_e88 * b_e88)) - 1.0f32)) + pressure_e24);
                }
            }
            let _e115 = i_v2;
            i_v2 = _e115.wrapping_add(1u32);
        }
    } else {
        let _e118 = s_v0;
        let _e119 = s_v0;
        let invariant_e122 = (dot(_e118, _e119) + 1.0f32);
        let shear_e128 = ((tet_a0).mu * (1.0f32 - (1.0f32 / invariant_e122)));
        let _e130 = s_v0[1];
        let _e132 = s_v0[2];
        let _e133 = (_e130 * _e132);
        let _e135 = s_v0[2];
        let _e137 = s_v0[0];
        let _e138 = (_e135 * _e137);
        let _e140 = s_v0[0];
        let _e142 = s_v0[1];
        let _e143 = (_e140 * _e142);
        let cofactor_e144 = [_e133, _e138, _e143];
        let _e147 = s_v0[0];
        let _e149 = s_v0[1];
        let _e152 = s_v0[2];
        let pressure_e160 = (((tet_a0).lambda * (((_e147 * _e149) * _e152) - 1.0f32)) - (0.75f32 * (tet_a0).mu));
        'l2: loop {
            'c2: {
                let _e163 = i_v4;
                if (_e163 < 3u32) {
                } else {
                    break 'l2;
                }
                {
                    let mut j_v5: u32;
                    j_v5 = 0u32;
                    'l3: loop {
                        'c3: {
                            let _e168 = j_v5;
                            if (_e168 < 3u32) {
                            } else {
                                break 'l3;
                            }
                            {
                                let _e176 = i_v4;
                                let _e178 = s_v0[_e176 as usize];
                                let _e180 = j_v5;
                                let _e182 = s_v0[_e180 as usize];
                                let _e185 = i_v4;
                                let _e188 = j_v5;
                                let mut value_v6: f32;
                                value_v6 = (((((2.0f32 * (tet_a0).mu) / (invariant_e122 * invariant_e122)) * _e178) * _e182) + (((tet_a0).lambda * (cofactor_e144)[_e185 as usize]) * (cofactor_e144)[_e188 as usize]));
                                let _e193 = i_v4;
                                let _e194 = j_v5;
                                if (_e193 == _e194) {
                                    let _e196 = value_v6;
                                    value_v6 = (_e196 + shear_e128);
                                } else {
                                    let _e198 = value_v6;
                                    let _e200 = i_v4;
                                    let _e202 = j_v5;
                                    let _e205 = s_v0[3u32.wrapping_sub(_e200).wrapping_sub(_e202) as usize];
                                    value_v6 = (_e198 + (pressure_e160 * _e205));
                                }
                                let _e210 = i_v4;
                                let _e212 = j_v5;
                                let _e215 = value_v6;
                                out_v1.scaling[3u32.wrapping_mul(_e210).wrapping_add(_e212) as usize] = _e215;
                            }
                        }
                        let _e216 = j_v5;
                        j_v5 = _e216.wrapping_add(1u32);
                    }
                    let _e220 = i_v4;
                    let _e222 = i_v4;
                    let _e224 = s_v0[_e222 as usize];
                    out_v1.flip[_e220 as usize] = (shear_e128 - (pressure_e160 * _e224));
                    let _e228 = i_v4;
                    let _e230 = i_v4;
                    let _e232 = s_v0[_e230 as usize];
                    out_v1.twist[_e228 as usize] = (shear_e128 + (pressure_e160 * _e232));
                }
            }
            let _e235 = i_v4;
            i_v4 = _e235.wrapping_add(1u32);
        }
    }
    let _e238 = out_v1;
    return _e238;
}

pub fn shape_of(tet_a0: Tetrahedron, axes_a1: [[f32; 3]; 3]) -> [[f32; 3]; 4] {
    let mut shape_v1: [[f32; 3]; 4] = [[0.0f32; 3]; 4];
    let mut a_v2: u32 = 0u32;
    let mut gradients_v0: [f32; 9];
    gradients_v0 = (tet_a0).gradients;
    'l0: loop {
        'c0: {
            let _e7 = a_v2;
            if (_e7 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e11 = a_v2;
                let _e14 = gradients_v0[3u32.wrapping_mul(_e11) as usize];
                let _e16 = a_v2;
                let _e21 = gradients_v0[3u32.wrapping_mul(_e16).wrapping_add(1u32) as usize];
                let _e23 = a_v2;
                let _e28 = gradients_v0[3u32.wrapping_mul(_e23).wrapping_add(2u32) as usize];
                let g_e29 = [_e14, _e21, _e28];
                let _e30 = a_v2;
                let _e35 = dot(g_e29, (axes_a1)[0]);
                let _e37 = dot(g_e29, (axes_a1)[1]);
                let _e39 = dot(g_e29, (axes_a1)[2]);
                shape_v1[_e30.wrapping_add(1u32) as usize] = [_e35, _e37, _e39];
            }
        }
        let _e41 = a_v2;
        a_v2 = _e41.wrapping_add(1u32);
    }
    let _e46 = shape_v1[1];
    let _e48 = shape_v1[2];
    let _e51 = shape_v1[3];
    shape_v1[0] = zip(zip(_e46, _e48, |x, y| (x + y)), _e51, |x, y| (x + y)).map(|x| (-x));
    let _e54 = shape_v1;
    return _e54;
}

pub fn is_definite(matrix_a0: [f32; 9], largest_a1: f32) -> bool {
    let mut k_v1: u32 = 0u32;
    let mut a_v0: [f32; 9];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e5 = k_v1;
            if (_e5 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v1;
                let pivot_e12 = a_v0[4u32.wrapping_mul(_e9) as usize];
                if (pivot_e12 <= (1e-6f32 * largest_a1)) {
                    return false;
                }
                let _e17 = k_v1;
                let mut i_v2: u32;
                i_v2 = _e17.wrapping_add(1u32);
                'l1: loop {
                    'c1: {
                        let _e21 = i_v2;
                        if (_e21 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e25 = i_v2;
                            let _e27 = k_v1;
                            let _e30 = a_v0[3u32.wrapping_mul(_e25).wrapping_add(_e27) as usize];
                            let factor_e31 = (_e30 / pivot_e12);
                            let _e32 = k_v1;
                            let mut j_v3: u32;
                            j_v3 = _e32.wrapping_add(1u32);
                            'l2: loop {
                                'c2: {
                                    let _e36 = j_v3;
                                    if (_e36 < 3u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e40 = i_v2;
                                        let _e42 = j_v3;
                                        let _e45 = a_v0[3u32.wrapping_mul(_e40).wrapping_add(_e42) as usize];
                                        let _e47 = k_v1;
                                        let _e49 = j_v3;
                                        let _e52 = a_v0[3u32.wrapping_mul(_e47).wrapping_add(_e49) as usize];
                                        a_v0[3u32.wrapping_mul(_e40).wrapping_add(_e42) as usize] = (_e45 - (factor_e31 * _e52));
                                    }
                                }
                                let _e55 = j_v3;
                                j_v3 = _e55.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e58 = i_v2;
                    i_v2 = _e58.wrapping_add(1u32);
                }
            }
        }
        let _e61 = k_v1;
        k_v1 = _e61.wrapping_add(1u32);
    }
    return true;
}

pub fn filtered_matrix(m: &mut Memory<'_>, matrix_a0: [f32; 9]) -> [f32; 9] {
    let mut largest_v1: f32 = 0.0f32;
    let mut k_v2: u32 = 0u32;
    let mut v_v3: [f32; 9] = [0.0f32; 9];
    let mut k_v4: u32 = 0u32;
    let mut sweep_v5: u32 = 0u32;
    let mut sum_v10: [f32; 9] = [0.0f32; 9];
    let mut k_v11: u32 = 0u32;
    let mut a_v0: [f32; 9];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e6 = k_v2;
            if (_e6 < 9u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = largest_v1;
                let _e10 = k_v2;
                let _e12 = a_v0[_e10 as usize];
                largest_v1 = _e9.max(_e12.abs());
            }
        }
        let _e15 = k_v2;
        k_v2 = _e15.wrapping_add(1u32);
    }
    let _e18 = a_v0;
    let _e19 = largest_v1;
    let _e20 = is_definite(_e18, _e19);
    if _e20 {
        let _e21 = a_v0;
        return _e21;
    }
    'l1: loop {
        'c1: {
            let _e25 = k_v4;
            if (_e25 < 3u32) {
            } else {
                break 'l1;
            }
            {
                let _e29 = k_v4;
                v_v3[4u32.wrapping_mul(_e29) as usize] = 1.0f32;
            }
        }
        let _e33 = k_v4;
        k_v4 = _e33.wrapping_add(1u32);
    }
    'l2: loop {
        'c2: {
            let _e38 = sweep_v5;
            if (_e38 < 6u32) {
            } else {
                break 'l2;
            }
            {
                let mut p_v6: u32;
                p_v6 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e43 = p_v6;
                        if (_e43 < 3u32) {
                        } else {
                            break 'l3;
                        }
                        {
                            let _e46 = p_v6;
                            let mut q_v7: u32;
                            q_v7 = _e46.wrapping_add(1u32);
                            'l4: loop {
                                'c4: {
                                    let _e50 = q_v7;
                                    if (_e50 < 3u32) {
                                    } else {
                                        break 'l4;
                                    }
                                    {
                                        let _e54 = p_v6;
                                        let _e56 = q_v7;
                                        let pq_e59 = a_v0[3u32.wrapping_mul(_e54).wrapping_add(_e56) as usize];
                                        let _e62 = largest_v1;
                                        if (pq_e59.abs() > (1e-8f32 * _e62)) {
                                            let _e66 = q_v7;
                                            let _e69 = a_v0[4u32.wrapping_mul(_e66) as usize];
                                            let _e71 = p_v6;
                                            let _e74 = a_v0[4u32.wrapping_mul(_e71) as usize];
                                            let tau_e78 = ((_e69 - _e74) / (2.0f32 * pq_e59));
                                            let size_e86 = (1.0f32 / (tau_e78.abs() + (1.0f32 + (tau_e78 * tau_e78)).sqrt()));
                                            let t_e90 = (if (tau_e78 >= 0.0f32) { size_e86 } else { (-size_e86) });
                                            let c_e96 = (1.0f32 / (1.0f32 + (t_e90 * t_e90)).sqrt());
                                            let s_e97 = (t_e90 * c_e96);
                                            let mut k_v8: u32;
                                            k_v8 = 0u32;
                                            'l5: loop {
                                                'c5: {
                                                    let _e100 = k_v8;
                                                    if (_e100 < 3u32) {
                                                    } else {
                                                        break 'l5;
                                                    }
                                                    {
                                                        let _e104 = k_v8;
                                                        let _e106 = p_v6;
                                                        let x_e109 = a_v0[3u32.wrapping_mul(_e104).wrapping_add(_e106) as usize];
                                                        let _e111 = k_v8;
                                                        let _e113 = q_v7;
                                                        let y_e116 = a_v0[3u32.wrapping_mul(_e111).wrapping_add(_e113) as usize];
                                                        let _e118 = k_v8;
                                                        let _e120 = p_v6;
                                                        a_v0[3u32.wrapping_mul(_e118).wrapping_add(_e120) as usize] = ((c_e96 * x_e109) - (s_e97 * y_e116));
                                                        let _e127 = k_v8;
                                                        let _e129 = q_v7;
                                                        a_v0[3u32.wrapping_mul(_e127).wrapping_add(_e129) as usize] = ((s_e97 * x_e109) + (c_e96 * y_e116));
                                                        let _e136 = k_v8;
                                                        let _e138 = p_v6;
                                                        let z_e141 = v_v3[3u32.wrapping_mul(_e136).wrapping_add(_e138) as usize];
                                                        let _e143 = k_v8;
                                                        let _e145 = q_v7;
                                                        let w_e148 = v_v3[3u32.wrapping_mul(_e143).wrapping_add(_e145) as usize];
                                                        let _e150 = k_v8;
                                                        let _e152 = p_v6;
                                                        v_v3[3u32.wrapping_mul(_e150).wrapping_add(_e152) as usize] = ((c_e96 * z_e141) - (s_e97 * w_e148));
                                                        let _e159 = k_v8;
                                                        let _e161 = q_v7;
                                                        v_v3[3u32.wrapping_mul(_e159).wrapping_add(_e161) as usize] = ((s_e97 * z_e141) + (c_e96 * w_e148));
                                                    }
                                                }
                                                let _e167 = k_v8;
                                                k_v8 = _e167.wrapping_add(1u32);
                                            }
                                            let mut k_v9: u32;
                                            k_v9 = 0u32;
                                            'l6: loop {
                                                'c6: {
                                                    let _e172 = k_v9;
                                                    if (_e172 < 3u32) {
                                                    } else {
                                                        break 'l6;
                                                    }
                                                    {
                                                        let _e176 = p_v6;
                                                        let _e178 = k_v9;
                                                        let x_e181 = a_v0[3u32.wrapping_mul(_e176).wrapping_add(_e178) as usize];
                                                        let _e183 = q_v7;
                                                        let _e185 = k_v9;
                                                        let y_e188 = a_v0[3u32.wrapping_mul(_e183).wrapping_add(_e185) as usize];
                                                        let _e190 = p_v6;
                                                        let _e192 = k_v9;
                                                        a_v0[3u32.wrapping_mul(_e190).wrapping_add(_e192) as usize] = ((c_e96 * x_e181) - (s_e97 * y_e188));
                                                        let _e199 = q_v7;
                                                        let _e201 = k_v9;
                                                        a_v0[3u32.wrapping_mul(_e199).wrapping_add(_e201) as usize] = ((s_e97 * x_e181) + (c_e96 * y_e188));
                                                    }
                                                }
                                                let _e207 = k_v9;
                                                k_v9 = _e207.wrapping_add(1u32);
                                            }
                                        }
                                    }
                                }
                                let _e210 = q_v7;
                                q_v7 = _e210.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e213 = p_v6;
                    p_v6 = _e213.wrapping_add(1u32);
                }
            }
        }
        let _e216 = sweep_v5;
        sweep_v5 = _e216.wrapping_add(1u32);
    }
    'l7: loop {
        'c7: {
            let _e222 = k_v11;
            if (_e222 < 3u32) {
            } else {
                break 'l7;
            }
            {
                let _e226 = k_v11;
                let _e229 = a_v0[4u32.wrapping_mul(_e226) as usize];
                let value_e230 = filtered(m, _e229);
                let mut i_v12: u32;
                i_v12 = 0u32;
                'l8: loop {
                    'c8: {
                        let _e233 = i_v12;
                        if (_e233 < 3u32) {
                        } else {
                            break 'l8;
                        }
                        {
                            let mut j_v13: u32;
                            j_v13 = 0u32;
                            'l9: loop {
                                'c9: {
                                    let _e238 = j_v13;
                                    if (_e238 < 3u32) {
                                    } else {
                                        break 'l9;
                                    }
                                    {
                                        let _e242 = i_v12;
                                        let _e244 = j_v13;
                                        let _e247 = sum_v10[3u32.wrapping_mul(_e242).wrapping_add(_e244) as usize];
                                        let _e249 = i_v12;
                                        let _e251 = k_v11;
                                        let _e254 = v_v3[3u32.wrapping_mul(_e249).wrapping_add(_e251) as usize];
                                        let _e257 = j_v13;
                                        let _e259 = k_v11;
                                        let _e262 = v_v3[3u32.wrapping_mul(_e257).wrapping_add(_e259) as usize];
                                        sum_v10[3u32.wrapping_mul(_e242).wrapping_add(_e244) as usize] = (_e247 + ((value_e230 * _e254) * _e262));
                                    }
                                }
                                let _e265 = j_v13;
                                j_v13 = _e265.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e268 = i_v12;
                    i_v12 = _e268.wrapping_add(1u32);
                }
            }
        }
        let _e271 = k_v11;
        k_v11 = _e271.wrapping_add(1u32);
    }
    let _e274 = sum_v10;
    return _e274;
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
                let tet_e11 = <Tetrahedron>::load(m.tetrahedra, 20 * (_e9 as usize));
                let mut local_v1: bool;
                if ((tet_e11).viscous_mu > 0.0f32) {
                    let _e19 = m.params.rate;
                    local_v1 = (_e19 > 0.0f32);
                } else {
                    local_v1 = false;
                }
                let _e23 = local_v1;
                if _e23 {
                    break 'c0;
                }
                let _e24 = deformation_of(m, tet_e11);
                let svd_e25 = singular_of(_e24);
                let curvatures_e27 = curvatures_of(tet_e11, (svd_e25).s);
                let _e29 = filtered_matrix(m, (curvatures_e27).scaling);
                let mut scaling_v2: [f32; 9];
                scaling_v2 = _e29;
                let mut even_v3: [f32; 3];
                even_v3 = [0.0f32; 3];
                let mut odd_v4: [f32; 3];
                odd_v4 = [0.0f32; 3];
                let mut k_v5: u32;
                k_v5 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e37 = k_v5;
                        if (_e37 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e41 = k_v5;
                            let a_e43 = filtered(m, ((curvatures_e27).flip)[_e41 as usize]);
                            let _e45 = k_v5;
                            let b_e47 = filtered(m, ((curvatures_e27).twist)[_e45 as usize]);
                            let _e48 = k_v5;
                            even_v3[_e48 as usize] = (0.5f32 * (a_e43 + b_e47));
                            let _e53 = k_v5;
                            odd_v4[_e53 as usize] = (0.5f32 * (a_e43 - b_e47));
                        }
                    }
                    let _e58 = k_v5;
                    k_v5 = _e58.wrapping_add(1u32);
                }
                let _e62 = shape_of(tet_e11, (svd_e25).v);
                let mut shape_v6: [[f32; 3]; 4];
                shape_v6 = _e62;
                let mut u_v7: [[f32; 3]; 3];
                u_v7 = (svd_e25).u;
                let _e67 = e_v0;
                let mut block_v8: u32;
                block_v8 = 6u32.wrapping_mul(_e67);
                let mut a_v9: u32;
                a_v9 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e72 = a_v9;
                        if (_e72 < 4u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e75 = a_v9;
                            let mut b_v10: u32;
                            b_v10 = _e75.wrapping_add(1u32);
                            'l3: loop {
                                'c3: {
                                    let _e79 = b_v10;
                                    if (_e79 < 4u32) {
                                    } else {
                                        break 'l3;
                                    }
                                    {
                                        let _e82 = a_v9;
                                        let g_e84 = shape_v6[_e82 as usize];
                                        let _e85 = b_v10;
                                        let h_e87 = shape_v6[_e85 as usize];
                                        let mut columns_v11: [[f32; 3]; 3];
                                        columns_v11 = [[0.0f32; 3]; 3];
                                        let mut i_v12: u32;
                                        i_v12 = 0u32;
                                        'l4: loop {
                                            'c4: {
                                                let _e92 = i_v12;
                                                if (_e92 < 3u32) {
                                                } else {
                                                    break 'l4;
                                                }
                                                {
                                                    let mut row_v13: [f32; 3];
                                                    row_v13 = [0.0f32; 3];
                                                    let mut j_v14: u32;
                                                    j_v14 = 0u32;
                                                    'l5: loop {
                                                        'c5: {
                                                            let _e100 = j_v14;
                                                            if (_e100 < 3u32) {
                                                            } else {
                                                                break 'l5;
                                                            }
                                                            {
                                                                let _e104 = i_v12;
                                                                let _e106 = j_v14;
                                                                let _e109 = scaling_v2[3u32.wrapping_mul(_e104).wrapping_add(_e106) as usize];
                                                                let _e110 = i_v12;
                                                                let _e113 = j_v14;
                                                                let mut value_v15: f32;
                                                                value_v15 = ((_e109 * (g_e84)[_e110 as usize]) * (h_e87)[_e113 as usize]);
                                                                let _e117 = i_v12;
                                                                let _e118 = j_v14;
                                                                if (_e117 == _e118) {
                                                                    let _e120 = i_v12;
                                                                    let x_e124 = (_e120.wrapping_add(1u32) % 3u32);
                                                                    let _e125 = i_v12;
                                                                    let y_e129 = (_e125.wrapping_add(2u32) % 3u32);
                                                                    let _e130 = value_v15;
                                                                    let _e132 = even_v3[y_e129 as usize];
                                                                    let _e138 = even_v3[x_e124 as usize];
                                                                    value_v15 = (_e130 + (((_e132 * (g_e84)[x_e124 as usize]) * (h_e87)[x_e124 as usize]) + ((_e138 * (g_e84)[y_e129 as usize]) * (h_e87)[y_e129 as usize])));
                                                                } else {
                                                                    let _e145 = value_v15;
                                                                    let _e147 = i_v12;
                                                                    let _e149 = j_v14;
                                                                    let _e152 = odd_v4[3u32.wrapping_sub(_e147).wrapping_sub(_e149) as usize];
                                                                    let _e153 = i_v12;
                                                                    let _e156 = j_v14;
                                                                    value_v15 = (_e145 + ((_e152 * (h_e87)[_e153 as usize]) * (g_e84)[_e156 as usize]));
                                                                }
                                                                let _e160 = row_v13;
                                                                let _e161 = j_v14;
                                                                let _e163 = u_v7[_e161 as usize];
                                                                let _e164 = value_v15;
                                                                row_v13 = zip(_e160, _e163.map(|x| (x * (_e164 * (tet_e11).volume))), |x, y| (x + y));
                                                            }
                                                        }
                                                        let _e169 = j_v14;
                                                        j_v14 = _e169.wrapping_add(1u32);
                                                    }
                                                    let mut k_v16: u32;
                                                    k_v16 = 0u32;
                                                    'l6: loop {
                                                        'c6: {
                                                            let _e174 = k_v16;
                                                            if (_e174 < 3u32) {
                                                            } else {
                                                                break 'l6;
                                                            }
                                                            {
                                                                let _e177 = k_v16;
                                                                let _e179 = columns_v11[_e177 as usize];
                                                                let _e180 = i_v12;
                                                                let _e182 = u_v7[_e180 as usize];
                                                                let _e183 = k_v16;
                                                                let _e185 = row_v13[_e183 as usize];
                                                                columns_v11[_e177 as usize] = zip(_e179, _e182.map(|x| (x * _e185)), |x, y| (x + y));
                                                            }
                                                        }
                                                        let _e188 = k_v16;
                                                        k_v16 = _e188.wrapping_add(1u32);
                                                    }
                                                }
                                            }
                                            let _e191 = i_v12;
                                            i_v12 = _e191.wrapping_add(1u32);
                                        }
                                        let _e194 = block_v8;
                                        let _e196 = columns_v11[0];
                                        let _e198 = columns_v11[1];
                                        let _e200 = columns_v11[2];
                                        put(m, _e194, _e196, _e198, _e200);
                                        let _e201 = block_v8;
                                        block_v8 = _e201.wrapping_add(1u32);
                                    }
                                }
                                let _e204 = b_v10;
                                b_v10 = _e204.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e207 = a_v9;
                    a_v9 = _e207.wrapping_add(1u32);
                }
            }
        }
        let _e210 = e_v0;
        e_v0 = _e210.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let tetrahedra = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut blocks = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        tetrahedra: &tetrahedra,
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
