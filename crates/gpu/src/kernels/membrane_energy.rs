// Written from `shader/elements/membrane_energy.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "membrane_energy",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/parts.wgsl"),
        include_str!("../../shader/shared/energies.wgsl"),
        include_str!("../../shader/shared/triangle.wgsl"),
        include_str!("../../shader/elements/membrane_energy.wgsl"),
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
use crate::kernels::membrane_energy::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Membrane {
    pub nodes: [u32; 3],
    pub area: f32,
    pub gradients: [f32; 4],
    pub stiffness: [f32; 4],
    pub damping: f32,
    pub padding: [u32; 3],
}

impl Membrane {
    const ZERO: Self = Self {
        nodes: [0u32; 3],
        area: 0.0f32,
        gradients: [0.0f32; 4],
        stiffness: [0.0f32; 4],
        damping: 0.0f32,
        padding: [0u32; 3],
    };
}

impl Stored for Membrane {
    const WORDS: usize = 16;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            nodes: <[u32; 3]>::load(words, at + 0),
            area: <f32>::load(words, at + 3),
            gradients: <[f32; 4]>::load(words, at + 4),
            stiffness: <[f32; 4]>::load(words, at + 8),
            damping: <f32>::load(words, at + 12),
            padding: <[u32; 3]>::load(words, at + 13),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.nodes.store(words, at + 0);
        self.area.store(words, at + 3);
        self.gradients.store(words, at + 4);
        self.stiffness.store(words, at + 8);
        self.damping.store(words, at + 12);
        self.padding.store(words, at + 13);
    }
}

struct Memory<'a> {
    params: EnergyParams,
    membranes: &'a [u32],
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

pub fn stress_of(stiffness_a0: [f32; 4], strain_a1: [f32; 3]) -> [f32; 3] {
    let _e8 = (((stiffness_a0)[0] * (strain_a1)[0]) + ((stiffness_a0)[1] * (strain_a1)[1]));
    let _e15 = (((stiffness_a0)[1] * (strain_a1)[0]) + ((stiffness_a0)[2] * (strain_a1)[1]));
    let _e20 = ((2.0f32 * (stiffness_a0)[3]) * (strain_a1)[2]);
    return [_e8, _e15, _e20];
}

pub fn increment(f0_a0: [f32; 3], f1_a1: [f32; 3], d0_a2: [f32; 3], d1_a3: [f32; 3]) -> [f32; 3] {
    let _e9 = (0.5f32 * dot(d0_a2, zip(f0_a0.map(|x| (2.0f32 * x)), d0_a2, |x, y| (x - y))));
    let _e15 = (0.5f32 * dot(d1_a3, zip(f1_a1.map(|x| (2.0f32 * x)), d1_a3, |x, y| (x - y))));
    let _e21 = (0.5f32 * (dot(d0_a2, f1_a1) + dot(zip(f0_a0, d0_a2, |x, y| (x - y)), d1_a3)));
    return [_e9, _e15, _e21];
}

pub fn stress_size(stiffness_a0: [f32; 4], strain_a1: [f32; 3]) -> [f32; 3] {
    let _e10 = (((stiffness_a0)[0].abs() * (strain_a1)[0]) + ((stiffness_a0)[1].abs() * (strain_a1)[1]));
    let _e19 = (((stiffness_a0)[1].abs() * (strain_a1)[0]) + ((stiffness_a0)[2].abs() * (strain_a1)[1]));
    let _e25 = ((2.0f32 * (stiffness_a0)[3].abs()) * (strain_a1)[2]);
    return [_e10, _e19, _e25];
}

pub fn work(stress_a0: [f32; 3], strain_a1: [f32; 3]) -> f32 {
    return ((((stress_a0)[0] * (strain_a1)[0]) + ((stress_a0)[1] * (strain_a1)[1])) + ((2.0f32 * (stress_a0)[2]) * (strain_a1)[2]));
}

pub fn energy(m: &mut Memory<'_>, m_a0: Membrane) -> [f32; 4] {
    let mut dj_v0: f32 = 0.0f32;
    let mut u_v1: [f32; 3] = [0.0f32; 3];
    let g_e1 = (m_a0).gradients;
    let e1_e6 = way(m, ((m_a0).nodes)[0], ((m_a0).nodes)[1]);
    let e2_e11 = way(m, ((m_a0).nodes)[0], ((m_a0).nodes)[2]);
    let f0_e16 = zip(e1_e6.map(|x| (x * (g_e1)[0])), e2_e11.map(|x| (x * (g_e1)[2])), |x, y| (x + y));
    let f1_e21 = zip(e1_e6.map(|x| (x * (g_e1)[1])), e2_e11.map(|x| (x * (g_e1)[3])), |x, y| (x + y));
    let b1_e26 = change(m, ((m_a0).nodes)[0], ((m_a0).nodes)[1]);
    let b2_e31 = change(m, ((m_a0).nodes)[0], ((m_a0).nodes)[2]);
    let d0_e36 = zip(b1_e26.map(|x| (x * (g_e1)[0])), b2_e31.map(|x| (x * (g_e1)[2])), |x, y| (x + y));
    let d1_e41 = zip(b1_e26.map(|x| (x * (g_e1)[1])), b2_e31.map(|x| (x * (g_e1)[3])), |x, y| (x + y));
    let t0_e42 = zip(f0_e16, d0_e36, |x, y| (x + y));
    let t1_e43 = zip(f1_e21, d1_e41, |x, y| (x + y));
    let _e44 = dot(f0_e16, f0_e16);
    let _e45 = dot(f1_e21, f1_e21);
    let _e46 = dot(f0_e16, f1_e21);
    let c_e47 = [_e44, _e45, _e46];
    let _e49 = dot(d0_e36, zip(f0_e16, t0_e42, |x, y| (x + y)));
    let _e51 = dot(d1_e41, zip(f1_e21, t1_e43, |x, y| (x + y)));
    let _e54 = (dot(d0_e36, t1_e43) + dot(f0_e16, d1_e41));
    let dc_e55 = [_e49, _e51, _e54];
    let normal_e56 = cross(f0_e16, f1_e21);
    let turn_e59 = zip(cross(d0_e36, t1_e43), cross(f0_e16, d1_e41), |x, y| (x + y));
    let j_e60 = dot(normal_e56, normal_e56).sqrt();
    let _e61 = zip(normal_e56, turn_e59, |x, y| (x + y));
    let both_e63 = (j_e60 + dot(_e61, _e61).sqrt());
    if (both_e63 > 1e-18f32) {
        dj_v0 = (dot(turn_e59, zip(normal_e56.map(|x| (2.0f32 * x)), turn_e59, |x, y| (x + y))) / both_e63);
    }
    let r_e79 = (((c_e47)[0] + (c_e47)[1]) + (2.0f32 * j_e60)).sqrt();
    let _e83 = zip(normal_e56, turn_e59, |x, y| (x + y));
    let r_trial_e90 = ((dot(t0_e42, t0_e42) + dot(t1_e43, t1_e43)) + (2.0f32 * dot(_e83, _e83).sqrt())).max(0.0f32).sqrt();
    if (r_e79 > 1e-18f32) {
        let _e97 = ((c_e47)[0] + j_e60);
        let _e99 = ((c_e47)[1] + j_e60);
        let _e100 = (c_e47)[2];
        u_v1 = zip([_e97, _e99, _e100], [r_e79; 3], |x, y| (x / y));
    }
    let _e104 = u_v1;
    let mut du_v2: [f32; 3];
    du_v2 = _e104.map(|x| (-x));
    let _e107 = u_v1;
    let mut size_v3: [f32; 3];
    size_v3 = _e107;
    if (r_trial_e90 > 1e-18f32) {
        let _e114 = dj_v0;
        let dr_e119 = ((((dc_e55)[0] + (dc_e55)[1]) + (2.0f32 * _e114)) / (r_e79 + r_trial_e90));
        let _e120 = dj_v0;
        let _e121 = dj_v0;
        let _e125 = u_v1;
        du_v2 = zip(zip(zip(dc_e55, [_e120, _e121, 0.0f32], |x, y| (x + y)), _e125.map(|x| (x * dr_e119)), |x, y| (x - y)), [r_trial_e90; 3], |x, y| (x / y));
        let l0_e130 = dot(d0_e36, d0_e36).sqrt();
        let l1_e131 = dot(d1_e41, d1_e41).sqrt();
        let across_e136 = ((l0_e130 * dot(t1_e43, t1_e43).sqrt()) + (dot(f0_e16, f0_e16).sqrt() * l1_e131));
        let _e137 = zip(f0_e16, t0_e42, |x, y| (x + y));
        let _e139 = (l0_e130 * dot(_e137, _e137).sqrt());
        let _e140 = zip(f1_e21, t1_e43, |x, y| (x + y));
        let _e142 = (l1_e131 * dot(_e140, _e140).sqrt());
        let sizes_e143 = [_e139, _e142, across_e136];
        let dr_size_e151 = ((((sizes_e143)[0] + (sizes_e143)[1]) + (2.0f32 * across_e136)) / (r_e79 + r_trial_e90));
        let _e155 = u_v1;
        size_v3 = zip(zip(zip(sizes_e143, [across_e136, across_e136, 0.0f32], |x, y| (x + y)), _e155.map(|x| x.abs()).map(|x| (x * dr_size_e151)), |x, y| (x + y)), [r_trial_e90; 3], |x, y| (x / y));
    }
    let _e161 = u_v1;
    let strain_e166 = zip(_e161, [1.0f32, 1.0f32, 0.0f32], |x, y| (x - y));
    let _e167 = du_v2;
    let mean_e170 = zip(strain_e166, _e167.map(|x| (0.5f32 * x)), |x, y| (x + y));
    let _e172 = stress_of((m_a0).stiffness, strain_e166);
    let _e173 = work(_e172, strain_e166);
    let _e175 = (0.5f32 * _e173);
    let _e177 = stress_of((m_a0).stiffness, mean_e170);
    let _e178 = du_v2;
    let _e179 = work(_e177, _e178);
    let _e185 = stress_size((m_a0).stiffness, zip(mean_e170.map(|x| x.abs()), [1.0f32; 3], |x, y| (x + y)));
    let _e186 = size_v3;
    let _e188 = work(_e185, _e186.map(|x| x.abs()));
    let mut out_v4: [f32; 3];
    out_v4 = [_e175, _e179, _e188];
    let mut local_v5: bool;
    if ((m_a0).damping > 0.0f32) {
        let _e198 = m.params.rate;
        local_v5 = (_e198 > 0.0f32);
    } else {
        local_v5 = false;
    }
    let _e202 = local_v5;
    if _e202 {
        let _e206 = m.params.rate;
        let factor_e207 = ((m_a0).damping * _e206);
        let a1_e212 = moved(m, ((m_a0).nodes)[0], ((m_a0).nodes)[1]);
        let a2_e217 = moved(m, ((m_a0).nodes)[0], ((m_a0).nodes)[2]);
        let h0_e222 = zip(a1_e212.map(|x| (x * (g_e1)[0])), a2_e217.map(|x| (x * (g_e1)[2])), |x, y| (x + y));
        let h1_e227 = zip(a1_e212.map(|x| (x * (g_e1)[1])), a2_e217.map(|x| (x * (g_e1)[3])), |x, y| (x + y));
        let before_e228 = increment(f0_e16, f1_e21, h0_e222, h1_e227);
        let between_e231 = zip(before_e228, dc_e55.map(|x| (0.25f32 * x)), |x, y| (x + y));
        let across_e238 = ((dot(d0_e36, d0_e36).sqrt() * dot(t1_e43, t1_e43).sqrt()) + (dot(f0_e16, f0_e16).sqrt() * dot(d1_e41, d1_e41).sqrt()));
        let _e240 = zip(f0_e16, t0_e42, |x, y| (x + y));
        let _e242 = (dot(d0_e36, d0_e36).sqrt() * dot(_e240, _e240).sqrt());
        let _e244 = zip(f1_e21, t1_e43, |x, y| (x + y));
        let _e246 = (dot(d1_e41, d1_e41).sqrt() * dot(_e244, _e244).sqrt());
        let dc_size_e247 = [_e242, _e246, across_e238];
        let _e251 = zip(f0_e16.map(|x| (2.0f32 * x)), h0_e222, |x, y| (x - y));
        let _e253 = (dot(h0_e222, h0_e222).sqrt() * dot(_e251, _e251).sqrt());
        let _e257 = zip(f1_e21.map(|x| (2.0f32 * x)), h1_e227, |x, y| (x - y));
        let _e259 = (dot(h1_e227, h1_e227).sqrt() * dot(_e257, _e257).sqrt());
        let _e263 = zip(f0_e16, h0_e222, |x, y| (x - y));
        let _e267 = ((dot(h0_e222, h0_e222).sqrt() * dot(f1_e21, f1_e21).sqrt()) + (dot(_e263, _e263).sqrt() * dot(h1_e227, h1_e227).sqrt()));
        let before_size_e270 = [_e253, _e259, _e267].map(|x| (0.5f32 * x));
        let _e271 = out_v4;
        let _e273 = stress_of((m_a0).stiffness, before_e228);
        let _e274 = work(_e273, before_e228);
        let _e276 = (0.5f32 * _e274);
        let _e278 = stress_of((m_a0).stiffness, between_e231);
        let _e279 = work(_e278, dc_e55);
        let _e281 = (0.5f32 * _e279);
        let _e286 = stress_size((m_a0).stiffness, zip(before_size_e270, dc_size_e247.map(|x| (0.25f32 * x)), |x, y| (x + y)));
        let _e287 = work(_e286, dc_size_e247);
        let _e289 = (0.5f32 * _e287);
        out_v4 = zip(_e271, [_e276, _e281, _e289].map(|x| (factor_e207 * x)), |x, y| (x + y));
    }
    let _e293 = out_v4;
    let _e296 = part(_e293.map(|x| (x * (m_a0).area)));
    return _e296;
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
                    let _e20 = <Membrane>::load(m.membranes, 16 * (_e18 as usize));
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
    let membranes = bound.read(0);
    let reference = bound.read(1);
    let trial = bound.read(2);
    let start = bound.read(3);
    let mut parts = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        membranes: &membranes,
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
