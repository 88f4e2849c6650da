// Written from `shader/elements/strand_energy.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "strand_energy",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/parts.wgsl"),
        include_str!("../../shader/shared/energies.wgsl"),
        include_str!("../../shader/shared/strand.wgsl"),
        include_str!("../../shader/elements/strand_energy.wgsl"),
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
use crate::kernels::strand_energy::*;
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

struct Memory<'a> {
    params: EnergyParams,
    strands: &'a [u32],
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

pub fn is_edge(strand_a0: Strand) -> bool {
    return (((strand_a0).nodes)[0] == ((strand_a0).nodes)[1]);
}

pub fn jump_of(strand_a0: Strand, first_a1: [f32; 3], second_a2: [f32; 3]) -> [f32; 3] {
    return zip(second_a2.map(|x| (x * ((strand_a0).inverse_lengths)[1])), first_a1.map(|x| (x * ((strand_a0).inverse_lengths)[0])), |x, y| (x - y));
}

pub fn energy(m: &mut Memory<'_>, strand_a0: Strand) -> [f32; 4] {
    let mut dq_v0: f32 = 0.0f32;
    let n_e1 = (strand_a0).nodes;
    let first_e4 = way(m, (n_e1)[0], (n_e1)[1]);
    let second_e7 = way(m, (n_e1)[1], (n_e1)[2]);
    let first_change_e10 = change(m, (n_e1)[0], (n_e1)[1]);
    let second_change_e13 = change(m, (n_e1)[1], (n_e1)[2]);
    let w_e14 = jump_of(strand_a0, first_e4, second_e7);
    let dw_e15 = jump_of(strand_a0, first_change_e10, second_change_e13);
    let size_e16 = dot(w_e14, w_e14).sqrt();
    let _e17 = zip(w_e14, dw_e15, |x, y| (x + y));
    let both_e19 = (size_e16 + dot(_e17, _e17).sqrt());
    if (both_e19 > 0.0f32) {
        dq_v0 = (dot(dw_e15, zip(w_e14.map(|x| (2.0f32 * x)), dw_e15, |x, y| (x + y))) / both_e19);
    }
    let a_e30 = ((strand_a0).inverse_lengths)[0];
    let c_e32 = ((strand_a0).inverse_lengths)[1];
    let moves_e37 = ((c_e32 * dot(second_change_e13, second_change_e13).sqrt()) + (a_e30 * dot(first_change_e10, first_change_e10).sqrt()));
    let reach_e43 = (((c_e32 * dot(second_e7, second_e7).sqrt()) + (a_e30 * dot(first_e4, first_e4).sqrt())) + moves_e37);
    let strain_e45 = (size_e16 - (strand_a0).rest);
    let mut changed_v1: f32;
    changed_v1 = moves_e37;
    let _e47 = is_edge(strand_a0);
    if _e47 {
        let _e48 = dq_v0;
        changed_v1 = _e48.abs();
    }
    let _e50 = changed_v1;
    let _e55 = dq_v0;
    let error_e59 = ((_e50 * (reach_e43 + (strand_a0).rest)) + (moves_e37 * (strain_e45.abs() + _e55.abs())));
    let _e62 = ((0.5f32 * strain_e45) * strain_e45);
    let _e63 = dq_v0;
    let _e64 = dq_v0;
    let _e68 = (_e63 * (strain_e45 + (0.5f32 * _e64)));
    let mut out_v2: [f32; 3];
    out_v2 = [_e62, _e68, error_e59];
    let mut local_v3: bool;
    if ((strand_a0).damping > 0.0f32) {
        let _e78 = m.params.rate;
        local_v3 = (_e78 > 0.0f32);
    } else {
        local_v3 = false;
    }
    let _e82 = local_v3;
    if _e82 {
        let _e86 = m.params.rate;
        let factor_e87 = ((strand_a0).damping * _e86);
        let _e90 = moved(m, (n_e1)[0], (n_e1)[1]);
        let _e93 = moved(m, (n_e1)[1], (n_e1)[2]);
        let turned_e94 = jump_of(strand_a0, _e90, _e93);
        let _e95 = is_edge(strand_a0);
        if _e95 {
            let before_e101 = (0.5f32 * dot(turned_e94, zip(w_e14.map(|x| (2.0f32 * x)), turned_e94, |x, y| (x - y))));
            let de_e107 = (0.5f32 * dot(dw_e15, zip(w_e14.map(|x| (2.0f32 * x)), dw_e15, |x, y| (x + y))));
            let de_size_e108 = (moves_e37 * reach_e43);
            let before_size_e114 = (dot(turned_e94, turned_e94).sqrt() * (reach_e43 + (0.5f32 * dot(turned_e94, turned_e94).sqrt())));
            let _e115 = out_v2;
            let _e118 = ((0.5f32 * before_e101) * before_e101);
            let _e122 = (de_e107 * (before_e101 + (0.5f32 * de_e107)));
            let _e124 = (de_size_e108 * (before_size_e114 + de_size_e108));
            out_v2 = zip(_e115, [_e118, _e122, _e124].map(|x| (factor_e87 * x)), |x, y| (x + y));
        } else {
            let _e130 = moved(m, (n_e1)[1], (n_e1)[2]);
            let _e135 = moved(m, (n_e1)[0], (n_e1)[1]);
            let sizes_e138 = ((c_e32 * dot(_e130, _e130).sqrt()) + (a_e30 * dot(_e135, _e135).sqrt()));
            let _e139 = out_v2;
            let _e142 = (0.5f32 * dot(turned_e94, turned_e94));
            let _e146 = dot(dw_e15, zip(turned_e94, dw_e15.map(|x| (0.5f32 * x)), |x, y| (x + y)));
            let _e148 = (moves_e37 * (sizes_e138 + moves_e37));
            out_v2 = zip(_e139, [_e142, _e146, _e148].map(|x| (factor_e87 * x)), |x, y| (x + y));
        }
    }
    let _e152 = out_v2;
    let _e155 = part(_e152.map(|x| (x * (strand_a0).stiffness)));
    return _e155;
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
                    let _e20 = <Strand>::load(m.strands, 8 * (_e18 as usize));
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
    let strands = bound.read(0);
    let reference = bound.read(1);
    let trial = bound.read(2);
    let start = bound.read(3);
    let mut parts = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        strands: &strands,
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
