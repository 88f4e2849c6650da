// Written from `shader/elements/bend_energy.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "bend_energy",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/parts.wgsl"),
        include_str!("../../shader/shared/energies.wgsl"),
        include_str!("../../shader/shared/normal.wgsl"),
        include_str!("../../shader/elements/bend_energy.wgsl"),
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
use crate::kernels::bend_energy::*;
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
    params: EnergyParams,
    bends: &'a [u32],
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

pub fn change(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.trial, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.trial, 4 * (a_a0 as usize));
    let _e13 = <[i32; 4]>::load(m.reference, 4 * (b_a1 as usize));
    let _e17 = <[i32; 4]>::load(m.reference, 4 * (a_a0 as usize));
    let _e24 = m.params.quantum;
    return zip(zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)), zip(swizzle(_e13, [0, 1, 2]), swizzle(_e17, [0, 1, 2]), |x, y| x.wrapping_sub(y)), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e24));
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

pub fn energy(m: &mut Memory<'_>, element_a0: Bend) -> [f32; 4] {
    let mut ways_v1: [[f32; 3]; 6] = [[0.0f32; 3]; 6];
    let mut changes_v2: [[f32; 3]; 6] = [[0.0f32; 3]; 6];
    let mut p_v3: u32 = 1u32;
    let mut means_v5: [[f32; 3]; 3] = [[0.0f32; 3]; 3];
    let mut residuals_v6: [[f32; 3]; 3] = [[0.0f32; 3]; 3];
    let mut turns_v7: [[f32; 3]; 3] = [[0.0f32; 3]; 3];
    let mut sizes_v8: [f32; 3] = [0.0f32; 3];
    let mut turn_sizes_v9: [f32; 3] = [0.0f32; 3];
    let mut i_v10: u32 = 0u32;
    let mut out_v16: [f32; 3] = [0.0f32; 3];
    let mut i_v17: u32 = 0u32;
    let mut bend_v0: Bend;
    bend_v0 = element_a0;
    'l0: loop {
        'c0: {
            let _e6 = p_v3;
            if (_e6 < 6u32) {
            } else {
                break 'l0;
            }
            {
                let _e10 = p_v3;
                let _e12 = bend_v0.nodes[_e10 as usize];
                if (_e12 != 4294967295u32) {
                    let _e15 = p_v3;
                    let _e19 = bend_v0.nodes[0];
                    let _e21 = p_v3;
                    let _e23 = bend_v0.nodes[_e21 as usize];
                    let _e24 = way(m, _e19, _e23);
                    ways_v1[_e15 as usize] = _e24;
                    let _e25 = p_v3;
                    let _e29 = bend_v0.nodes[0];
                    let _e31 = p_v3;
                    let _e33 = bend_v0.nodes[_e31 as usize];
                    let _e34 = change(m, _e29, _e33);
                    changes_v2[_e25 as usize] = _e34;
                }
            }
        }
        let _e35 = p_v3;
        p_v3 = _e35.wrapping_add(1u32);
    }
    let g_e39 = bend_v0.gradients;
    let _e41 = ways_v1[1];
    let _e45 = ways_v1[2];
    let f1_e48 = zip(_e41.map(|x| (x * (g_e39)[0])), _e45.map(|x| (x * (g_e39)[2])), |x, y| (x + y));
    let _e50 = ways_v1[1];
    let _e54 = ways_v1[2];
    let f2_e57 = zip(_e50.map(|x| (x * (g_e39)[1])), _e54.map(|x| (x * (g_e39)[3])), |x, y| (x + y));
    let _e59 = changes_v2[1];
    let _e63 = changes_v2[2];
    let d1_e66 = zip(_e59.map(|x| (x * (g_e39)[0])), _e63.map(|x| (x * (g_e39)[2])), |x, y| (x + y));
    let _e68 = changes_v2[1];
    let _e72 = changes_v2[2];
    let d2_e75 = zip(_e68.map(|x| (x * (g_e39)[1])), _e72.map(|x| (x * (g_e39)[3])), |x, y| (x + y));
    let _e78 = bend_v0.crushed;
    let normal_e79 = normal_of(cross(f1_e48, f2_e57), _e78);
    let dm_e83 = zip(cross(d1_e66, zip(f2_e57, d2_e75, |x, y| (x + y))), cross(f1_e48, d2_e75), |x, y| (x + y));
    let _e85 = zip(f2_e57, d2_e75, |x, y| (x + y));
    let dm_size_e91 = ((dot(d1_e66, d1_e66).sqrt() * dot(_e85, _e85).sqrt()) + (dot(f1_e48, f1_e48).sqrt() * dot(d2_e75, d2_e75).sqrt()));
    let _e95 = bend_v0.crushed;
    let trial_e96 = normal_of(zip((normal_e79).m_, dm_e83, |x, y| (x + y)), _e95);
    let q_e98 = (normal_e79).squared.sqrt();
    let q_trial_e100 = (trial_e96).squared.sqrt();
    let dq_e107 = (dot(dm_e83, zip((normal_e79).m_.map(|x| (2.0f32 * x)), dm_e83, |x, y| (x + y))) / (q_e98 + q_trial_e100));
    let dn_e115 = zip(dm_e83.map(|x| (x * (trial_e96).scale)), (normal_e79).m_.map(|x| (x * (((normal_e79).scale * dq_e107) / q_trial_e100))), |x, y| (x - y));
    let n_e118 = (normal_e79).m_.map(|x| (x * (normal_e79).scale));
    let _e119 = bend_v0;
    let _e120 = factors_of(_e119);
    let mut factors_v4: [f32; 18];
    factors_v4 = _e120;
    'l1: loop {
        'c1: {
            let _e129 = i_v10;
            if (_e129 < 3u32) {
            } else {
                break 'l1;
            }
            {
                let _e134 = i_v10;
                let c_e139 = bend_v0.rest[3u32.wrapping_mul(_e134).wrapping_add(2u32) as usize];
                let mut r_v11: [f32; 3];
                r_v11 = n_e118.map(|x| (x * (-c_e139)));
                let mut dr_v12: [f32; 3];
                dr_v12 = dn_e115.map(|x| (x * (-c_e139)));
                let mut r_size_v13: f32;
                r_size_v13 = c_e139.abs();
                let mut dr_size_v14: f32;
                dr_size_v14 = (((2.0f32 * c_e139.abs()) * dm_size_e91) * (trial_e96).scale);
                let mut p_v15: u32;
                p_v15 = 1u32;
                'l2: loop {
                    'c2: {
                        let _e157 = p_v15;
                        if (_e157 < 6u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            let _e161 = i_v10;
                            let _e163 = p_v15;
                            let factor_e166 = factors_v4[6u32.wrapping_mul(_e161).wrapping_add(_e163) as usize];
                            let _e167 = r_v11;
                            let _e168 = p_v15;
                            let _e170 = ways_v1[_e168 as usize];
                            r_v11 = zip(_e167, _e170.map(|x| (x * factor_e166)), |x, y| (x + y));
                            let _e173 = dr_v12;
                            let _e174 = p_v15;
                            let _e176 = changes_v2[_e174 as usize];
                            dr_v12 = zip(_e173, _e176.map(|x| (x * factor_e166)), |x, y| (x + y));
                            let _e179 = r_size_v13;
                            let _e180 = p_v15;
                            let _e182 = ways_v1[_e180 as usize];
                            r_size_v13 = (_e179 + (dot(_e182, _e182).sqrt() * factor_e166.abs()));
                            let _e187 = dr_size_v14;
                            let _e188 = p_v15;
                            let _e190 = changes_v2[_e188 as usize];
                            dr_size_v14 = (_e187 + (dot(_e190, _e190).sqrt() * factor_e166.abs()));
                        }
                    }
                    let _e195 = p_v15;
                    p_v15 = _e195.wrapping_add(1u32);
                }
                let _e198 = i_v10;
                let _e200 = r_v11;
                residuals_v6[_e198 as usize] = _e200;
                let _e201 = i_v10;
                let _e203 = dr_v12;
                turns_v7[_e201 as usize] = _e203;
                let _e204 = i_v10;
                let _e206 = r_v11;
                let _e207 = dr_v12;
                means_v5[_e204 as usize] = zip(_e206, _e207.map(|x| (0.5f32 * x)), |x, y| (x + y));
                let _e211 = i_v10;
                let _e213 = r_size_v13;
                let _e214 = dr_size_v14;
                sizes_v8[_e211 as usize] = (_e213 + (0.5f32 * _e214));
                let _e218 = i_v10;
                let _e220 = dr_size_v14;
                turn_sizes_v9[_e218 as usize] = _e220;
            }
        }
        let _e221 = i_v10;
        i_v10 = _e221.wrapping_add(1u32);
    }
    'l3: loop {
        'c3: {
            let _e229 = i_v17;
            if (_e229 < 3u32) {
            } else {
                break 'l3;
            }
            {
                let mut k_v18: u32;
                k_v18 = 0u32;
                'l4: loop {
                    'c4: {
                        let _e234 = k_v18;
                        if (_e234 < 3u32) {
                        } else {
                            break 'l4;
                        }
                        {
                            let _e239 = i_v17;
                            let _e241 = k_v18;
                            let value_e244 = bend_v0.gram[3u32.wrapping_mul(_e239).wrapping_add(_e241) as usize];
                            let _e245 = out_v16;
                            let _e248 = i_v17;
                            let _e250 = residuals_v6[_e248 as usize];
                            let _e251 = k_v18;
                            let _e253 = residuals_v6[_e251 as usize];
                            let _e255 = ((0.5f32 * value_e244) * dot(_e250, _e253));
                            let _e256 = i_v17;
                            let _e258 = turns_v7[_e256 as usize];
                            let _e259 = k_v18;
                            let _e261 = means_v5[_e259 as usize];
                            let _e263 = (value_e244 * dot(_e258, _e261));
                            let _e265 = i_v17;
                            let _e267 = turn_sizes_v9[_e265 as usize];
                            let _e269 = k_v18;
                            let _e271 = sizes_v8[_e269 as usize];
                            let _e272 = ((value_e244.abs() * _e267) * _e271);
                            out_v16 = zip(_e245, [_e255, _e263, _e272], |x, y| (x + y));
                        }
                    }
                    let _e275 = k_v18;
                    k_v18 = _e275.wrapping_add(1u32);
                }
            }
        }
        let _e278 = i_v17;
        i_v17 = _e278.wrapping_add(1u32);
    }
    let _e281 = out_v16;
    let _e282 = part(_e281);
    return _e282;
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
                    let _e20 = <Bend>::load(m.bends, 48 * (_e18 as usize));
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
    let bends = bound.read(0);
    let reference = bound.read(1);
    let trial = bound.read(2);
    let start = bound.read(3);
    let mut parts = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        bends: &bends,
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
