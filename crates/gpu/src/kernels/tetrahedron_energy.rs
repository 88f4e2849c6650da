// Written from `shader/elements/tetrahedron_energy.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "tetrahedron_energy",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/parts.wgsl"),
        include_str!("../../shader/shared/energies.wgsl"),
        include_str!("../../shader/shared/strain.wgsl"),
        include_str!("../../shader/shared/logarithm.wgsl"),
        include_str!("../../shader/elements/tetrahedron_energy.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const TINY: f32 = 1e-18f32;
pub const MIN_RATIO: f32 = 0.05f32;
pub const THREADS: u32 = 64u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct EnergyParams {
    pub count: u32,
    pub first: u32,
    pub workgroups: u32,
    pub rate: f32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::tetrahedron_energy::*;
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
    params: EnergyParams,
    tetrahedra: &'a [u32],
    reference: &'a [u32],
    trial: &'a [u32],
    start: &'a [u32],
    parts: &'a mut [u32],
    shared_parts: [[f32; 4]; 64],
}

pub fn part(energy_a0: [f32; 3]) -> [f32; 4] {
    let _e3 = ((energy_a0)[2] * (energy_a0)[2]);
    return [(energy_a0)[0], (energy_a0)[1], (energy_a0)[2], _e3];
}

pub fn put_part(m: &mut Memory<'_>, group_a0: [u32; 64], thread_a1: [u32; 64], value_a2: [[f32; 4]; 64]) {
    let mut reach_v0: u32 = 32u32;
    for t in 0..64 {
        m.shared_parts[thread_a1[t] as usize] = value_a2[t];
    }
    'l0: loop {
        'c0: {
            let _e7 = reach_v0;
            if (_e7 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e10 = reach_v0;
                for t in 0..64 {
                    if (thread_a1[t] < _e10) {
                        let _e14 = m.shared_parts[thread_a1[t] as usize];
                        let _e16 = reach_v0;
                        let _e19 = m.shared_parts[thread_a1[t].wrapping_add(_e16) as usize];
                        m.shared_parts[thread_a1[t] as usize] = zip(_e14, _e19, |x, y| (x + y));
                    }
                }
            }
        }
        let _e21 = reach_v0;
        reach_v0 = (_e21 / 2u32);
    }
    for t in 0..64 {
        if (thread_a1[t] == 0u32) {
            let _e29 = m.params.first;
            let _e34 = m.shared_parts[0];
            Stored::store(_e34, m.parts, 4 * (_e29.wrapping_add(group_a0[t]) as usize));
        }
    }
}

pub fn way(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.reference, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.reference, 4 * (a_a0 as usize));
    let _e14 = m.params.quantum;
    return zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e14));
}

pub fn moved(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.reference, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.reference, 4 * (a_a0 as usize));
    let _e13 = <[i32; 4]>::load(m.start, 4 * (b_a1 as usize));
    let _e17 = <[i32; 4]>::load(m.start, 4 * (a_a0 as usize));
    let _e24 = m.params.quantum;
    return zip(zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)), zip(swizzle(_e13, [0, 1, 2]), swizzle(_e17, [0, 1, 2]), |x, y| x.wrapping_sub(y)), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e24));
}

pub fn change(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.trial, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.trial, 4 * (a_a0 as usize));
    let _e13 = <[i32; 4]>::load(m.reference, 4 * (b_a1 as usize));
    let _e17 = <[i32; 4]>::load(m.reference, 4 * (a_a0 as usize));
    let _e24 = m.params.quantum;
    return zip(zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)), zip(swizzle(_e13, [0, 1, 2]), swizzle(_e17, [0, 1, 2]), |x, y| x.wrapping_sub(y)), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e24));
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

pub fn log_1p(x_a0: f32) -> f32 {
    let bits_e5 = (1.0f32 + x_a0).max(1e-30f32).to_bits();
    let mut exponent_v0: i32;
    exponent_v0 = (bits_e5.wrapping_shr(23u32) as i32).wrapping_sub(127i32);
    let mut mantissa_v1: f32;
    mantissa_v1 = f32::from_bits(((bits_e5 & 8388607u32) | 1065353216u32) as u32);
    let _e18 = mantissa_v1;
    if (_e18 > 1.4142135f32) {
        let _e21 = mantissa_v1;
        mantissa_v1 = (_e21 * 0.5f32);
        let _e24 = exponent_v0;
        exponent_v0 = _e24.wrapping_add(1i32);
    }
    let mut z_v2: f32;
    z_v2 = (x_a0 / (2.0f32 + x_a0));
    let _e31 = exponent_v0;
    if (_e31 != 0i32) {
        let _e34 = mantissa_v1;
        let _e37 = mantissa_v1;
        z_v2 = ((_e34 - 1.0f32) / (_e37 + 1.0f32));
    }
    let _e41 = z_v2;
    let _e42 = z_v2;
    let s_e43 = (_e41 * _e42);
    let series_e56 = (1.0f32 + (s_e43 * (0.33333334f32 + (s_e43 * (0.2f32 + (s_e43 * (0.14285713f32 + (s_e43 * 0.11111111f32))))))));
    let _e57 = exponent_v0;
    let _e61 = z_v2;
    return (((_e57 as f32) * 0.6931472f32) + ((2.0f32 * _e61) * series_e56));
}

pub fn product(a_a0: [[f32; 3]; 3], b_a1: [[f32; 3]; 3]) -> f32 {
    return ((dot((a_a0)[0], (b_a1)[0]) + dot((a_a0)[1], (b_a1)[1])) + dot((a_a0)[2], (b_a1)[2]));
}

pub fn squared_norm(f_a0: [[f32; 3]; 3]) -> f32 {
    return ((dot((f_a0)[0], (f_a0)[0]) + dot((f_a0)[1], (f_a0)[1])) + dot((f_a0)[2], (f_a0)[2]));
}

pub fn density(tet_a0: Tetrahedron, strain_a1: [[f32; 3]; 3], j_a2: f32) -> f32 {
    let trace_e10 = ((((strain_a1)[0])[0] + ((strain_a1)[1])[1]) + ((strain_a1)[2])[2]);
    let _e12 = product(strain_a1, strain_a1);
    let second_e15 = (0.5f32 * ((trace_e10 * trace_e10) - _e12));
    let third_e20 = dot((strain_a1)[0], cross((strain_a1)[1], (strain_a1)[2]));
    let mut grow_v0: f32;
    grow_v0 = (j_a2 - 1.0f32);
    let _e26 = grow_v0;
    let mut first_order_v1: f32;
    first_order_v1 = ((2.0f32 * trace_e10) - (2.0f32 * _e26));
    if (j_a2 > 0.5f32) {
        grow_v0 = ((((2.0f32 * trace_e10) + (4.0f32 * second_e15)) + (8.0f32 * third_e20)) / (j_a2 + 1.0f32));
        let _e46 = grow_v0;
        first_order_v1 = (((((2.0f32 * trace_e10) * _e46) - (8.0f32 * second_e15)) - (16.0f32 * third_e20)) / (j_a2 + 1.0f32));
    }
    let half_e58 = (0.5f32 * trace_e10);
    let _e62 = first_order_v1;
    let _e67 = log_1p(half_e58);
    let _e74 = grow_v0;
    let _e76 = grow_v0;
    return ((((0.375f32 * (tet_a0).mu) * _e62) + ((0.5f32 * (tet_a0).mu) * (half_e58 - _e67))) + (((0.5f32 * (tet_a0).lambda) * _e74) * _e76));
}

pub fn energy(m: &mut Memory<'_>, tet_a0: Tetrahedron) -> [f32; 4] {
    let n_e1 = (tet_a0).nodes;
    let f_e2 = deformation_of(m, tet_a0);
    let _e5 = change(m, (n_e1)[0], (n_e1)[1]);
    let _e8 = change(m, (n_e1)[0], (n_e1)[2]);
    let _e11 = change(m, (n_e1)[0], (n_e1)[3]);
    let d_e12 = columns_of(tet_a0, _e5, _e8, _e11);
    let _e15 = zip((f_e2)[0], (d_e12)[0], |x, y| (x + y));
    let _e18 = zip((f_e2)[1], (d_e12)[1], |x, y| (x + y));
    let _e21 = zip((f_e2)[2], (d_e12)[2], |x, y| (x + y));
    let t_e22 = [_e15, _e18, _e21];
    let strain_e23 = green_strain(f_e2);
    let turn_e24 = green_increment(t_e22, d_e12);
    let _e25 = squared_norm(d_e12);
    let moves_e26 = _e25.sqrt();
    let _e27 = squared_norm(f_e2);
    let large_e29 = (_e27.sqrt() + moves_e26);
    let turn_size_e30 = (moves_e26 * large_e29);
    let mut out_v0: [f32; 3];
    if ((tet_a0).law == 0u32) {
        let stress_e40 = law_stress(zip(strain_e23, turn_e24.map(|column| column.map(|x| (x * 0.5f32))), |a, b| zip(a, b, |x, y| (x + y))), (tet_a0).lambda, (tet_a0).mu);
        let _e43 = law_stress(strain_e23, (tet_a0).lambda, (tet_a0).mu);
        let _e44 = product(_e43, strain_e23);
        let _e46 = (0.5f32 * _e44);
        let _e47 = product(stress_e40, turn_e24);
        let _e61 = (((((2.0f32 * (tet_a0).mu) + (3.0f32 * (tet_a0).lambda)) * 0.5f32) * ((large_e29 * large_e29) + 3.0f32)) * turn_size_e30);
        out_v0 = [_e46, _e47, _e61];
    } else {
        let across_e65 = cross((f_e2)[1], (f_e2)[2]);
        let across_change_e72 = zip(cross((d_e12)[1], (t_e22)[2]), cross((f_e2)[1], (d_e12)[2]), |x, y| (x + y));
        let j_e74 = dot((f_e2)[0], across_e65);
        let dj_e80 = (dot((d_e12)[0], zip(across_e65, across_change_e72, |x, y| (x + y))) + dot((f_e2)[0], across_change_e72));
        let di_e97 = ((dot((d_e12)[0], zip((f_e2)[0], (t_e22)[0], |x, y| (x + y))) + dot((d_e12)[1], zip((f_e2)[1], (t_e22)[1], |x, y| (x + y)))) + dot((d_e12)[2], zip((f_e2)[2], (t_e22)[2], |x, y| (x + y))));
        let _e98 = squared_norm(f_e2);
        let logarithm_e102 = log_1p((di_e97 / (_e98 + 1.0f32)));
        let pressure_e113 = (((tet_a0).lambda * ((j_e74 + (0.5f32 * dj_e80)) - 1.0f32)) - (0.75f32 * (tet_a0).mu));
        let pressure_size_e125 = (((tet_a0).lambda * ((((0.2f32 * large_e29) * large_e29) * large_e29) + 1.0f32)) + (0.75f32 * (tet_a0).mu));
        let _e126 = density(tet_a0, strain_e23, j_e74);
        let _e133 = (((0.5f32 * (tet_a0).mu) * (di_e97 - logarithm_e102)) + (pressure_e113 * dj_e80));
        let _e142 = (((2.0f32 * (tet_a0).mu) * turn_size_e30) + (((pressure_size_e125 * 0.6f32) * large_e29) * turn_size_e30));
        out_v0 = [_e126, _e133, _e142];
    }
    let mut local_v1: bool;
    if ((tet_a0).viscous_mu > 0.0f32) {
        let _e151 = m.params.rate;
        local_v1 = (_e151 > 0.0f32);
    } else {
        local_v1 = false;
    }
    let _e155 = local_v1;
    if _e155 {
        let h_e156 = moved_of(m, tet_a0);
        let _e160 = m.params.rate;
        let lambda_e161 = ((tet_a0).viscous_lambda * _e160);
        let _e165 = m.params.rate;
        let mu_e166 = ((tet_a0).viscous_mu * _e165);
        let before_e167 = green_increment(f_e2, h_e156);
        let _e168 = squared_norm(h_e156);
        let way_since_e169 = _e168.sqrt();
        let _e170 = out_v0;
        let _e171 = law_stress(before_e167, lambda_e161, mu_e166);
        let _e172 = product(_e171, before_e167);
        let _e174 = (0.5f32 * _e172);
        let _e178 = law_stress(zip(before_e167, turn_e24.map(|column| column.map(|x| (x * 0.5f32))), |a, b| zip(a, b, |x, y| (x + y))), lambda_e161, mu_e166);
        let _e179 = product(_e178, turn_e24);
        let _e189 = ((((2.0f32 * mu_e166) + (3.0f32 * lambda_e161)) * ((way_since_e169 * (large_e29 + way_since_e169)) + turn_size_e30)) * turn_size_e30);
        out_v0 = zip(_e170, [_e174, _e179, _e189], |x, y| (x + y));
    }
    let _e192 = out_v0;
    let _e195 = part(_e192.map(|x| (x * (tet_a0).volume)));
    return _e195;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut sum_v0: [[f32; 4]; 64] = [[0.0f32; 4]; 64];
    let mut _e32: [[f32; 4]; 64] = [[0.0f32; 4]; 64];
    for t in 0..64 {
        let mut e_v1: u32;
        e_v1 = 64u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(([t as u32, 0, 0])[0]);
        'l0: loop {
            'c0: {
                let _e11 = e_v1;
                let _e14 = m.params.count;
                if (_e11 < _e14) {
                } else {
                    break 'l0;
                }
                {
                    let _e16 = sum_v0[t];
                    let _e18 = e_v1;
                    let _e20 = <Tetrahedron>::load(m.tetrahedra, 20 * (_e18 as usize));
                    let _e21 = energy(m, _e20);
                    sum_v0[t] = zip(_e16, _e21, |x, y| (x + y));
                }
            }
            let _e23 = e_v1;
            let _e27 = m.params.workgroups;
            e_v1 = _e23.wrapping_add(64u32.wrapping_mul(_e27));
        }
        _e32[t] = sum_v0[t];
    }
    put_part(m, std::array::from_fn::<_, 64, _>(|t| ([group, 0, 0])[0]), std::array::from_fn::<_, 64, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 64, _>(|t| _e32[t]));
}

pub fn run(bound: Bound<'_>) {
    let tetrahedra = bound.read(0);
    let reference = bound.read(1);
    let trial = bound.read(2);
    let start = bound.read(3);
    let mut parts = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        tetrahedra: &tetrahedra,
        reference: &reference,
        trial: &trial,
        start: &start,
        parts: &mut parts,
        shared_parts: [[0.0f32; 4]; 64],
    };
    for group in 0..bound.workgroups() {
        m.shared_parts = [[0.0f32; 4]; 64];
        main(&mut m, group as u32);
    }
}
}
