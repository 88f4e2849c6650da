// Written from `shader/elements/damped_tetrahedron_hessian.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "damped_tetrahedron_hessian",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/blocks.wgsl"),
        include_str!("../../shader/shared/strain.wgsl"),
        include_str!("../../shader/shared/solid.wgsl"),
        include_str!("../../shader/shared/eigen.wgsl"),
        include_str!("../../shader/elements/damped_tetrahedron_hessian.wgsl"),
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
pub const ORDER: u32 = 9u32;

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
use crate::kernels::damped_tetrahedron_hessian::*;
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

pub fn moved_of(m: &mut Memory<'_>, tet_a0: Tetrahedron) -> [[f32; 3]; 3] {
    let n_e1 = (tet_a0).nodes;
    let _e4 = moved(m, (n_e1)[0], (n_e1)[1]);
    let _e7 = moved(m, (n_e1)[0], (n_e1)[2]);
    let _e10 = moved(m, (n_e1)[0], (n_e1)[3]);
    let _e11 = columns_of(tet_a0, _e4, _e7, _e10);
    return _e11;
}

pub fn green_increment(f_a0: [[f32; 3]; 3], d_a1: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let a_e6 = zip((f_a0)[0].map(|x| (2.0f32 * x)), (d_a1)[0], |x, y| (x - y));
    let b_e11 = zip((f_a0)[1].map(|x| (2.0f32 * x)), (d_a1)[1], |x, y| (x - y));
    let c_e16 = zip((f_a0)[2].map(|x| (2.0f32 * x)), (d_a1)[2], |x, y| (x - y));
    let xy_e23 = (0.25f32 * (dot((d_a1)[0], b_e11) + dot((d_a1)[1], a_e6)));
    let xz_e30 = (0.25f32 * (dot((d_a1)[0], c_e16) + dot((d_a1)[2], a_e6)));
    let yz_e37 = (0.25f32 * (dot((d_a1)[1], c_e16) + dot((d_a1)[2], b_e11)));
    let _e41 = (0.5f32 * dot((d_a1)[0], a_e6));
    let _e42 = [_e41, xy_e23, xz_e30];
    let _e46 = (0.5f32 * dot((d_a1)[1], b_e11));
    let _e47 = [xy_e23, _e46, yz_e37];
    let _e51 = (0.5f32 * dot((d_a1)[2], c_e16));
    let _e52 = [xz_e30, yz_e37, _e51];
    return [_e42, _e47, _e52];
}

pub fn law_stress(strain_a0: [[f32; 3]; 3], lambda_a1: f32, mu_a2: f32) -> [[f32; 3]; 3] {
    let pressure_e11 = (lambda_a1 * ((((strain_a0)[0])[0] + ((strain_a0)[1])[1]) + ((strain_a0)[2])[2]));
    let _e19 = zip((strain_a0)[0].map(|x| (x * (2.0f32 * mu_a2))), [pressure_e11, 0.0f32, 0.0f32], |x, y| (x + y));
    let _e27 = zip((strain_a0)[1].map(|x| (x * (2.0f32 * mu_a2))), [0.0f32, pressure_e11, 0.0f32], |x, y| (x + y));
    let _e35 = zip((strain_a0)[2].map(|x| (x * (2.0f32 * mu_a2))), [0.0f32, 0.0f32, pressure_e11], |x, y| (x + y));
    return [_e19, _e27, _e35];
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

pub fn is_definite(matrix_a0: [f32; 81], largest_a1: f32) -> bool {
    let mut k_v1: u32 = 0u32;
    let mut a_v0: [f32; 81];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e5 = k_v1;
            if (_e5 < 9u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v1;
                let pivot_e12 = a_v0[10u32.wrapping_mul(_e9) as usize];
                if (pivot_e12 <= (1e-6f32 * largest_a1)) {
                    return false;
                }
                let _e17 = k_v1;
                let mut i_v2: u32;
                i_v2 = _e17.wrapping_add(1u32);
                'l1: loop {
                    'c1: {
                        let _e21 = i_v2;
                        if (_e21 < 9u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e25 = i_v2;
                            let _e27 = k_v1;
                            let _e30 = a_v0[9u32.wrapping_mul(_e25).wrapping_add(_e27) as usize];
                            let factor_e31 = (_e30 / pivot_e12);
                            let _e32 = k_v1;
                            let mut j_v3: u32;
                            j_v3 = _e32.wrapping_add(1u32);
                            'l2: loop {
                                'c2: {
                                    let _e36 = j_v3;
                                    if (_e36 < 9u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e40 = i_v2;
                                        let _e42 = j_v3;
                                        let _e45 = a_v0[9u32.wrapping_mul(_e40).wrapping_add(_e42) as usize];
                                        let _e47 = k_v1;
                                        let _e49 = j_v3;
                                        let _e52 = a_v0[9u32.wrapping_mul(_e47).wrapping_add(_e49) as usize];
                                        a_v0[9u32.wrapping_mul(_e40).wrapping_add(_e42) as usize] = (_e45 - (factor_e31 * _e52));
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

pub fn filtered_matrix(m: &mut Memory<'_>, matrix_a0: [f32; 81]) -> [f32; 81] {
    let mut largest_v1: f32 = 0.0f32;
    let mut k_v2: u32 = 0u32;
    let mut v_v3: [f32; 81] = [0.0f32; 81];
    let mut k_v4: u32 = 0u32;
    let mut sweep_v5: u32 = 0u32;
    let mut sum_v10: [f32; 81] = [0.0f32; 81];
    let mut k_v11: u32 = 0u32;
    let mut a_v0: [f32; 81];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e6 = k_v2;
            if (_e6 < 81u32) {
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
            if (_e25 < 9u32) {
            } else {
                break 'l1;
            }
            {
                let _e29 = k_v4;
                v_v3[10u32.wrapping_mul(_e29) as usize] = 1.0f32;
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
                        if (_e43 < 9u32) {
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
                                    if (_e50 < 9u32) {
                                    } else {
                                        break 'l4;
                                    }
                                    {
                                        let _e54 = p_v6;
                                        let _e56 = q_v7;
                                        let pq_e59 = a_v0[9u32.wrapping_mul(_e54).wrapping_add(_e56) as usize];
                                        let _e62 = largest_v1;
                                        if (pq_e59.abs() > (1e-8f32 * _e62)) {
                                            let _e66 = q_v7;
                                            let _e69 = a_v0[10u32.wrapping_mul(_e66) as usize];
                                            let _e71 = p_v6;
                                            let _e74 = a_v0[10u32.wrapping_mul(_e71) as usize];
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
                                                    if (_e100 < 9u32) {
                                                    } else {
                                                        break 'l5;
                                                    }
                                                    {
                                                        let _e104 = k_v8;
                                                        let _e106 = p_v6;
                                                        let x_e109 = a_v0[9u32.wrapping_mul(_e104).wrapping_add(_e106) as usize];
                                                        let _e111 = k_v8;
                                                        let _e113 = q_v7;
                                                        let y_e116 = a_v0[9u32.wrapping_mul(_e111).wrapping_add(_e113) as usize];
                                                        let _e118 = k_v8;
                                                        let _e120 = p_v6;
                                                        a_v0[9u32.wrapping_mul(_e118).wrapping_add(_e120) as usize] = ((c_e96 * x_e109) - (s_e97 * y_e116));
                                                        let _e127 = k_v8;
                                                        let _e129 = q_v7;
                                                        a_v0[9u32.wrapping_mul(_e127).wrapping_add(_e129) as usize] = ((s_e97 * x_e109) + (c_e96 * y_e116));
                                                        let _e136 = k_v8;
                                                        let _e138 = p_v6;
                                                        let z_e141 = v_v3[9u32.wrapping_mul(_e136).wrapping_add(_e138) as usize];
                                                        let _e143 = k_v8;
                                                        let _e145 = q_v7;
                                                        let w_e148 = v_v3[9u32.wrapping_mul(_e143).wrapping_add(_e145) as usize];
                                                        let _e150 = k_v8;
                                                        let _e152 = p_v6;
                                                        v_v3[9u32.wrapping_mul(_e150).wrapping_add(_e152) as usize] = ((c_e96 * z_e141) - (s_e97 * w_e148));
                                                        let _e159 = k_v8;
                                                        let _e161 = q_v7;
                                                        v_v3[9u32.wrapping_mul(_e159).wrapping_add(_e161) as usize] = ((s_e97 * z_e141) + (c_e96 * w_e148));
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
                                                    if (_e172 < 9u32) {
                                                    } else {
                                                        break 'l6;
                                                    }
                                                    {
                                                        let _e176 = p_v6;
                                                        let _e178 = k_v9;
                                                        let x_e181 = a_v0[9u32.wrapping_mul(_e176).wrapping_add(_e178) as usize];
                                                        let _e183 = q_v7;
                                                        let _e185 = k_v9;
                                                        let y_e188 = a_v0[9u32.wrapping_mul(_e183).wrapping_add(_e185) as usize];
                                                        let _e190 = p_v6;
                                                        let _e192 = k_v9;
                                                        a_v0[9u32.wrapping_mul(_e190).wrapping_add(_e192) as usize] = ((c_e96 * x_e181) - (s_e97 * y_e188));
                                                        let _e199 = q_v7;
                                                        let _e201 = k_v9;
                                                        a_v0[9u32.wrapping_mul(_e199).wrapping_add(_e201) as usize] = ((s_e97 * x_e181) + (c_e96 * y_e188));
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
            if (_e222 < 9u32) {
            } else {
                break 'l7;
            }
            {
                let _e226 = k_v11;
                let _e229 = a_v0[10u32.wrapping_mul(_e226) as usize];
                let value_e230 = filtered(m, _e229);
                let mut i_v12: u32;
                i_v12 = 0u32;
                'l8: loop {
                    'c8: {
                        let _e233 = i_v12;
                        if (_e233 < 9u32) {
                        } else {
                            break 'l8;
                        }
                        {
                            let mut j_v13: u32;
                            j_v13 = 0u32;
                            'l9: loop {
                                'c9: {
                                    let _e238 = j_v13;
                                    if (_e238 < 9u32) {
                                    } else {
                                        break 'l9;
                                    }
                                    {
                                        let _e242 = i_v12;
                                        let _e244 = j_v13;
                                        let _e247 = sum_v10[9u32.wrapping_mul(_e242).wrapping_add(_e244) as usize];
                                        let _e249 = i_v12;
                                        let _e251 = k_v11;
                                        let _e254 = v_v3[9u32.wrapping_mul(_e249).wrapping_add(_e251) as usize];
                                        let _e257 = j_v13;
                                        let _e259 = k_v11;
                                        let _e262 = v_v3[9u32.wrapping_mul(_e257).wrapping_add(_e259) as usize];
                                        sum_v10[9u32.wrapping_mul(_e242).wrapping_add(_e244) as usize] = (_e247 + ((value_e230 * _e254) * _e262));
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

pub fn times_columns(m_a0: [[f32; 3]; 3], v_a1: [f32; 3]) -> [f32; 3] {
    return zip(zip((m_a0)[0].map(|x| (x * (v_a1)[0])), (m_a0)[1].map(|x| (x * (v_a1)[1])), |x, y| (x + y)), (m_a0)[2].map(|x| (x * (v_a1)[2])), |x, y| (x + y));
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
                if (!_e23) {
                    break 'c0;
                }
                let f_e25 = deformation_of(m, tet_e11);
                let d_e26 = moved_of(m, tet_e11);
                let _e27 = singular_of(f_e25);
                let mut svd_v2: Singular;
                svd_v2 = _e27;
                let _e30 = svd_v2.s;
                let mut s_v3: [f32; 3];
                s_v3 = _e30;
                let _e32 = s_v3;
                let _e33 = curvatures_of(tet_e11, _e32);
                let mut curvatures_v4: Curvatures;
                curvatures_v4 = _e33;
                let _e38 = m.params.rate;
                let lambda_e39 = ((tet_e11).viscous_lambda * _e38);
                let _e43 = m.params.rate;
                let mu_e44 = ((tet_e11).viscous_mu * _e43);
                let mut now_v5: [[f32; 3]; 3];
                now_v5 = [[0.0f32; 3]; 3];
                let mut change_v6: [[f32; 3]; 3];
                change_v6 = [[0.0f32; 3]; 3];
                let mut k_v7: u32;
                k_v7 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e51 = k_v7;
                        if (_e51 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e54 = k_v7;
                            let _e57 = k_v7;
                            let _e59 = svd_v2.v[_e57 as usize];
                            let _e60 = times_columns(f_e25, _e59);
                            now_v5[_e54 as usize] = _e60;
                            let _e61 = k_v7;
                            let _e64 = k_v7;
                            let _e66 = svd_v2.v[_e64 as usize];
                            let _e67 = times_columns(d_e26, _e66);
                            change_v6[_e61 as usize] = _e67;
                        }
                    }
                    let _e68 = k_v7;
                    k_v7 = _e68.wrapping_add(1u32);
                }
                let _e71 = now_v5;
                let _e72 = change_v6;
                let _e73 = green_increment(_e71, _e72);
                let _e74 = law_stress(_e73, lambda_e39, mu_e44);
                let mut viscous_v8: [[f32; 3]; 3];
                viscous_v8 = _e74;
                let mut curvature_v9: [f32; 81];
                curvature_v9 = [0.0f32; 81];
                let mut i_v10: u32;
                i_v10 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e80 = i_v10;
                        if (_e80 < 3u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let mut j_v11: u32;
                            j_v11 = 0u32;
                            'l3: loop {
                                'c3: {
                                    let _e85 = j_v11;
                                    if (_e85 < 3u32) {
                                    } else {
                                        break 'l3;
                                    }
                                    {
                                        let _e89 = i_v10;
                                        let _e92 = j_v11;
                                        let _e96 = curvature_v9[36u32.wrapping_mul(_e89).wrapping_add(4u32.wrapping_mul(_e92)) as usize];
                                        let _e99 = i_v10;
                                        let _e101 = j_v11;
                                        let _e104 = curvatures_v4.scaling[3u32.wrapping_mul(_e99).wrapping_add(_e101) as usize];
                                        let _e105 = i_v10;
                                        let _e107 = s_v3[_e105 as usize];
                                        let _e109 = j_v11;
                                        let _e111 = s_v3[_e109 as usize];
                                        curvature_v9[36u32.wrapping_mul(_e89).wrapping_add(4u32.wrapping_mul(_e92)) as usize] = (_e96 + (_e104 + ((lambda_e39 * _e107) * _e111)));
                                        let mut k_v12: u32;
                                        k_v12 = 0u32;
                                        'l4: loop {
                                            'c4: {
                                                let _e117 = k_v12;
                                                if (_e117 < 3u32) {
                                                } else {
                                                    break 'l4;
                                                }
                                                {
                                                    let _e122 = i_v10;
                                                    let _e124 = j_v11;
                                                    let _e128 = i_v10;
                                                    let _e131 = k_v12;
                                                    let _e134 = curvature_v9[9u32.wrapping_mul(3u32.wrapping_mul(_e122).wrapping_add(_e124)).wrapping_add(3u32.wrapping_mul(_e128)).wrapping_add(_e131) as usize];
                                                    let _e135 = j_v11;
                                                    let _e137 = k_v12;
                                                    let _e139 = viscous_v8[_e135 as usize][_e137 as usize];
                                                    curvature_v9[9u32.wrapping_mul(3u32.wrapping_mul(_e122).wrapping_add(_e124)).wrapping_add(3u32.wrapping_mul(_e128)).wrapping_add(_e131) as usize] = (_e134 + _e139);
                                                }
                                            }
                                            let _e141 = k_v12;
                                            k_v12 = _e141.wrapping_add(1u32);
                                        }
                                    }
                                }
                                let _e144 = j_v11;
                                j_v11 = _e144.wrapping_add(1u32);
                            }
                            let _e148 = i_v10;
                            let _e151 = curvature_v9[40u32.wrapping_mul(_e148) as usize];
                            let _e154 = i_v10;
                            let _e156 = s_v3[_e154 as usize];
                            let _e158 = i_v10;
                            let _e160 = s_v3[_e158 as usize];
                            curvature_v9[40u32.wrapping_mul(_e148) as usize] = (_e151 + (((2.0f32 * mu_e44) * _e156) * _e160));
                        }
                    }
                    let _e163 = i_v10;
                    i_v10 = _e163.wrapping_add(1u32);
                }
                let mut k_v13: u32;
                k_v13 = 0u32;
                'l5: loop {
                    'c5: {
                        let _e168 = k_v13;
                        if (_e168 < 3u32) {
                        } else {
                            break 'l5;
                        }
                        {
                            let _e171 = k_v13;
                            let i_e175 = (_e171.wrapping_add(1u32) % 3u32);
                            let _e176 = k_v13;
                            let j_e180 = (_e176.wrapping_add(2u32) % 3u32);
                            let _e182 = k_v13;
                            let _e184 = curvatures_v4.flip[_e182 as usize];
                            let _e186 = k_v13;
                            let _e188 = curvatures_v4.twist[_e186 as usize];
                            let even_e191 = (0.5f32 * (_e184 + _e188));
                            let _e193 = k_v13;
                            let _e195 = curvatures_v4.flip[_e193 as usize];
                            let _e197 = k_v13;
                            let _e199 = curvatures_v4.twist[_e197 as usize];
                            let odd_e202 = (0.5f32 * (_e195 - _e199));
                            let ij_e205 = 3u32.wrapping_mul(i_e175).wrapping_add(j_e180);
                            let ji_e208 = 3u32.wrapping_mul(j_e180).wrapping_add(i_e175);
                            let _e212 = curvature_v9[10u32.wrapping_mul(ij_e205) as usize];
                            let _e214 = s_v3[i_e175 as usize];
                            let _e217 = s_v3[i_e175 as usize];
                            curvature_v9[10u32.wrapping_mul(ij_e205) as usize] = (_e212 + (even_e191 + ((mu_e44 * _e214) * _e217)));
                            let _e224 = curvature_v9[10u32.wrapping_mul(ji_e208) as usize];
                            let _e226 = s_v3[j_e180 as usize];
                            let _e229 = s_v3[j_e180 as usize];
                            curvature_v9[10u32.wrapping_mul(ji_e208) as usize] = (_e224 + (even_e191 + ((mu_e44 * _e226) * _e229)));
                            let _e237 = curvature_v9[9u32.wrapping_mul(ij_e205).wrapping_add(ji_e208) as usize];
                            let _e239 = s_v3[i_e175 as usize];
                            let _e242 = s_v3[j_e180 as usize];
                            curvature_v9[9u32.wrapping_mul(ij_e205).wrapping_add(ji_e208) as usize] = (_e237 + (odd_e202 + ((mu_e44 * _e239) * _e242)));
                            let _e250 = curvature_v9[9u32.wrapping_mul(ji_e208).wrapping_add(ij_e205) as usize];
                            let _e252 = s_v3[i_e175 as usize];
                            let _e255 = s_v3[j_e180 as usize];
                            curvature_v9[9u32.wrapping_mul(ji_e208).wrapping_add(ij_e205) as usize] = (_e250 + (odd_e202 + ((mu_e44 * _e252) * _e255)));
                        }
                    }
                    let _e259 = k_v13;
                    k_v13 = _e259.wrapping_add(1u32);
                }
                let _e262 = curvature_v9;
                let _e263 = filtered_matrix(m, _e262);
                curvature_v9 = _e263;
                let _e265 = svd_v2.v;
                let _e266 = shape_of(tet_e11, _e265);
                let mut shape_v14: [[f32; 3]; 4];
                shape_v14 = _e266;
                let _e269 = svd_v2.u;
                let mut u_v15: [[f32; 3]; 3];
                u_v15 = _e269;
                let _e272 = e_v0;
                let mut block_v16: u32;
                block_v16 = 6u32.wrapping_mul(_e272);
                let mut a_v17: u32;
                a_v17 = 0u32;
                'l6: loop {
                    'c6: {
                        let _e277 = a_v17;
                        if (_e277 < 4u32) {
                        } else {
                            break 'l6;
                        }
                        {
                            let _e280 = a_v17;
                            let mut b_v18: u32;
                            b_v18 = _e280.wrapping_add(1u32);
                            'l7: loop {
                                'c7: {
                                    let _e284 = b_v18;
                                    if (_e284 < 4u32) {
                                    } else {
                                        break 'l7;
                                    }
                                    {
                                        let _e287 = a_v17;
                                        let g_e289 = shape_v14[_e287 as usize];
                                        let _e290 = b_v18;
                                        let h_e292 = shape_v14[_e290 as usize];
                                        let mut columns_v19: [[f32; 3]; 3];
                                        columns_v19 = [[0.0f32; 3]; 3];
                                        let mut i_v20: u32;
                                        i_v20 = 0u32;
                                        'l8: loop {
                                            'c8: {
                                                let _e297 = i_v20;
                                                if (_e297 < 3u32) {
                                                } else {
                                                    break 'l8;
                                                }
                                                {
                                                    let mut row_v21: [f32; 3];
                                                    row_v21 = [0.0f32; 3];
                                                    let mut j_v22: u32;
                                                    j_v22 = 0u32;
                                                    'l9: loop {
                                                        'c9: {
                                                            let _e305 = j_v22;
                                                            if (_e305 < 3u32) {
                                                            } else {
                                                                break 'l9;
                                                            }
                                                            {
                                                                let mut value_v23: f32;
                                                                value_v23 = 0.0f32;
                                                                let mut k_v24: u32;
                                                                k_v24 = 0u32;
                                                                'l10: loop {
                                                                    'c10: {
                                                                        let _e312 = k_v24;
                                                                        if (_e312 < 9u32) {
                                                                        } else {
                                                                            break 'l10;
                                                                        }
                                                                        {
                                                                            let _e315 = value_v23;
                                                                            let _e316 = k_v24;
                                                                            let _e322 = i_v20;
                                                                            let _e324 = k_v24;
                                                                            let _e330 = j_v22;
                                                                            let _e333 = k_v24;
                                                                            let _e338 = curvature_v9[9u32.wrapping_mul(3u32.wrapping_mul(_e322).wrapping_add((_e324 / 3u32))).wrapping_add(3u32.wrapping_mul(_e330)).wrapping_add((_e333 % 3u32)) as usize];
                                                                            let _e340 = k_v24;
                                                                            value_v23 = (_e315 + (((g_e289)[(_e316 / 3u32) as usize] * _e338) * (h_e292)[(_e340 % 3u32) as usize]));
                                                                        }
                                                                    }
                                                                    let _e346 = k_v24;
                                                                    k_v24 = _e346.wrapping_add(1u32);
                                                                }
                                                                let _e349 = row_v21;
                                                                let _e350 = j_v22;
                                                                let _e352 = u_v15[_e350 as usize];
                                                                let _e353 = value_v23;
                                                                row_v21 = zip(_e349, _e352.map(|x| (x * (_e353 * (tet_e11).volume))), |x, y| (x + y));
                                                            }
                                                        }
                                                        let _e358 = j_v22;
                                                        j_v22 = _e358.wrapping_add(1u32);
                                                    }
                                                    let mut k_v25: u32;
                                                    k_v25 = 0u32;
                                                    'l11: loop {
                                                        'c11: {
                                                            let _e363 = k_v25;
                                                            if (_e363 < 3u32) {
                                                            } else {
                                                                break 'l11;
                                                            }
                                                            {
                                                                let _e366 = k_v25;
                                                                let _e368 = columns_v19[_e366 as usize];
                                                                let _e369 = i_v20;
                                                                let _e371 = u_v15[_e369 as usize];
                                                                let _e372 = k_v25;
                                                                let _e374 = row_v21[_e372 as usize];
                                                                columns_v19[_e366 as usize] = zip(_e368, _e371.map(|x| (x * _e374)), |x, y| (x + y));
                                                            }
                                                        }
                                                        let _e377 = k_v25;
                                                        k_v25 = _e377.wrapping_add(1u32);
                                                    }
                                                }
                                            }
                                            let _e380 = i_v20;
                                            i_v20 = _e380.wrapping_add(1u32);
                                        }
                                        let _e383 = block_v16;
                                        let _e385 = columns_v19[0];
                                        let _e387 = columns_v19[1];
                                        let _e389 = columns_v19[2];
                                        put(m, _e383, _e385, _e387, _e389);
                                        let _e390 = block_v16;
                                        block_v16 = _e390.wrapping_add(1u32);
                                    }
                                }
                                let _e393 = b_v18;
                                b_v18 = _e393.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e396 = a_v17;
                    a_v17 = _e396.wrapping_add(1u32);
                }
            }
        }
        let _e399 = e_v0;
        e_v0 = _e399.wrapping_add(4194240u32);
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
