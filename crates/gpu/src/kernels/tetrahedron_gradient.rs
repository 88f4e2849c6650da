// Written from `shader/elements/tetrahedron_gradient.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "tetrahedron_gradient",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/gradients.wgsl"),
        include_str!("../../shader/shared/strain.wgsl"),
        include_str!("../../shader/elements/tetrahedron_gradient.wgsl"),
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
use crate::kernels::tetrahedron_gradient::*;
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

struct Memory<'a> {
    params: GradientParams,
    tetrahedra: &'a [u32],
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

pub fn moved(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e13 = <[i32; 4]>::load(m.start, 4 * (b_a1 as usize));
    let _e17 = <[i32; 4]>::load(m.start, 4 * (a_a0 as usize));
    let _e24 = m.params.quantum;
    return zip(zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)), zip(swizzle(_e13, [0, 1, 2]), swizzle(_e17, [0, 1, 2]), |x, y| x.wrapping_sub(y)), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e24));
}

pub fn put(m: &mut Memory<'_>, entry_a0: u32, gradient_a1: [f32; 3]) {
    let _e5 = m.params.first;
    let at_e7 = 3u32.wrapping_mul(_e5.wrapping_add(entry_a0));
    Stored::store((gradient_a1)[0], m.gradients, 1 * (at_e7 as usize));
    Stored::store((gradient_a1)[1], m.gradients, 1 * (at_e7.wrapping_add(1u32) as usize));
    Stored::store((gradient_a1)[2], m.gradients, 1 * (at_e7.wrapping_add(2u32) as usize));
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

pub fn green_strain(f_a0: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let xy_e5 = (0.5f32 * dot((f_a0)[0], (f_a0)[1]));
    let xz_e10 = (0.5f32 * dot((f_a0)[0], (f_a0)[2]));
    let yz_e15 = (0.5f32 * dot((f_a0)[1], (f_a0)[2]));
    let _e22 = (0.5f32 * (dot((f_a0)[0], (f_a0)[0]) - 1.0f32));
    let _e23 = [_e22, xy_e5, xz_e10];
    let _e30 = (0.5f32 * (dot((f_a0)[1], (f_a0)[1]) - 1.0f32));
    let _e31 = [xy_e5, _e30, yz_e15];
    let _e38 = (0.5f32 * (dot((f_a0)[2], (f_a0)[2]) - 1.0f32));
    let _e39 = [xz_e10, yz_e15, _e38];
    return [_e23, _e31, _e39];
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
                let f_e12 = deformation_of(m, tet_e11);
                let mut s_v1: [[f32; 3]; 3];
                s_v1 = [[0.0f32; 3]; 3];
                let mut stress_v2: [[f32; 3]; 3];
                stress_v2 = [[0.0f32; 3]; 3];
                if ((tet_e11).law == 0u32) {
                    let _e20 = green_strain(f_e12);
                    let _e23 = law_stress(_e20, (tet_e11).lambda, (tet_e11).mu);
                    s_v1 = _e23;
                } else {
                    let invariant_e36 = (((dot((f_e12)[0], (f_e12)[0]) + dot((f_e12)[1], (f_e12)[1])) + dot((f_e12)[2], (f_e12)[2])) + 1.0f32);
                    let shear_e42 = ((tet_e11).mu * (1.0f32 - (1.0f32 / invariant_e36)));
                    let across_e45 = cross((f_e12)[1], (f_e12)[2]);
                    let pressure_e55 = (((tet_e11).lambda * (dot((f_e12)[0], across_e45) - 1.0f32)) - (0.75f32 * (tet_e11).mu));
                    let _e59 = zip((f_e12)[0].map(|x| (x * shear_e42)), across_e45.map(|x| (x * pressure_e55)), |x, y| (x + y));
                    let _e66 = zip((f_e12)[1].map(|x| (x * shear_e42)), cross((f_e12)[2], (f_e12)[0]).map(|x| (x * pressure_e55)), |x, y| (x + y));
                    let _e73 = zip((f_e12)[2].map(|x| (x * shear_e42)), cross((f_e12)[0], (f_e12)[1]).map(|x| (x * pressure_e55)), |x, y| (x + y));
                    stress_v2 = [_e59, _e66, _e73];
                }
                let mut local_v3: bool;
                if ((tet_e11).viscous_mu > 0.0f32) {
                    let _e82 = m.params.rate;
                    local_v3 = (_e82 > 0.0f32);
                } else {
                    local_v3 = false;
                }
                let _e86 = local_v3;
                if _e86 {
                    let _e87 = moved_of(m, tet_e11);
                    let strain_e88 = green_increment(f_e12, _e87);
                    let _e89 = s_v1;
                    let _e93 = m.params.rate;
                    let _e98 = m.params.rate;
                    let _e100 = law_stress(strain_e88, ((tet_e11).viscous_lambda * _e93), ((tet_e11).viscous_mu * _e98));
                    s_v1 = zip(_e89, _e100, |a, b| zip(a, b, |x, y| (x + y)));
                }
                let mut k_v4: u32;
                k_v4 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e104 = k_v4;
                        if (_e104 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e107 = k_v4;
                            let _e109 = stress_v2[_e107 as usize];
                            let _e111 = k_v4;
                            let _e114 = s_v1[_e111 as usize][0];
                            let _e117 = k_v4;
                            let _e120 = s_v1[_e117 as usize][1];
                            let _e124 = k_v4;
                            let _e127 = s_v1[_e124 as usize][2];
                            stress_v2[_e107 as usize] = zip(_e109, zip(zip((f_e12)[0].map(|x| (x * _e114)), (f_e12)[1].map(|x| (x * _e120)), |x, y| (x + y)), (f_e12)[2].map(|x| (x * _e127)), |x, y| (x + y)), |x, y| (x + y));
                        }
                    }
                    let _e131 = k_v4;
                    k_v4 = _e131.wrapping_add(1u32);
                }
                let mut rest_v5: [f32; 3];
                rest_v5 = [0.0f32; 3];
                let mut gradients_at_rest_v6: [f32; 9];
                gradients_at_rest_v6 = (tet_e11).gradients;
                let mut a_v7: u32;
                a_v7 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e141 = a_v7;
                        if (_e141 < 3u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e145 = stress_v2[0];
                            let _e147 = a_v7;
                            let _e150 = gradients_at_rest_v6[3u32.wrapping_mul(_e147) as usize];
                            let _e153 = stress_v2[1];
                            let _e155 = a_v7;
                            let _e160 = gradients_at_rest_v6[3u32.wrapping_mul(_e155).wrapping_add(1u32) as usize];
                            let _e164 = stress_v2[2];
                            let _e166 = a_v7;
                            let _e171 = gradients_at_rest_v6[3u32.wrapping_mul(_e166).wrapping_add(2u32) as usize];
                            let force_e175 = zip(zip(_e145.map(|x| (x * _e150)), _e153.map(|x| (x * _e160)), |x, y| (x + y)), _e164.map(|x| (x * _e171)), |x, y| (x + y)).map(|x| (x * (tet_e11).volume));
                            let _e177 = e_v0;
                            let _e179 = a_v7;
                            put(m, 4u32.wrapping_mul(_e177).wrapping_add(_e179).wrapping_add(1u32), force_e175);
                            let _e183 = rest_v5;
                            rest_v5 = zip(_e183, force_e175, |x, y| (x + y));
                        }
                    }
                    let _e185 = a_v7;
                    a_v7 = _e185.wrapping_add(1u32);
                }
                let _e189 = e_v0;
                let _e191 = rest_v5;
                put(m, 4u32.wrapping_mul(_e189), _e191.map(|x| (-x)));
            }
        }
        let _e193 = e_v0;
        e_v0 = _e193.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let tetrahedra = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut gradients = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        tetrahedra: &tetrahedra,
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
