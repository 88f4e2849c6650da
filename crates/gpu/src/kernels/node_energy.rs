// Written from `shader/elements/node_energy.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "node_energy",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/parts.wgsl"),
        include_str!("../../shader/shared/terms.wgsl"),
        include_str!("../../shader/elements/node_energy.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
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
use crate::kernels::node_energy::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Pair {
    pub node: u32,
    pub value: f32,
}

impl Pair {
    const ZERO: Self = Self {
        node: 0u32,
        value: 0.0f32,
    };
}

impl Stored for Pair {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            node: <u32>::load(words, at + 0),
            value: <f32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.node.store(words, at + 0);
        self.value.store(words, at + 1);
    }
}

struct Memory<'a> {
    params: EnergyParams,
    ranges: &'a [u32],
    pairs: &'a [u32],
    terms: &'a [u32],
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

pub fn row_sum_times(m: &mut Memory<'_>, i_a0: u32, x_a1: [f32; 3]) -> [f32; 3] {
    let r_e5 = <[f32; 6]>::load(m.terms, 9 * (i_a0 as usize));
    let _e16 = ((((r_e5)[0] * (x_a1)[0]) + ((r_e5)[1] * (x_a1)[1])) + ((r_e5)[2] * (x_a1)[2]));
    let _e27 = ((((r_e5)[1] * (x_a1)[0]) + ((r_e5)[3] * (x_a1)[1])) + ((r_e5)[4] * (x_a1)[2]));
    let _e38 = ((((r_e5)[2] * (x_a1)[0]) + ((r_e5)[4] * (x_a1)[1])) + ((r_e5)[5] * (x_a1)[2]));
    return [_e16, _e27, _e38];
}

pub fn linear_term(m: &mut Memory<'_>, i_a0: u32) -> [f32; 3] {
    let c_e4 = <[f32; 3]>::load(m.terms, 9 * (i_a0 as usize) + 6);
    let _e5 = (c_e4)[0];
    let _e6 = (c_e4)[1];
    let _e7 = (c_e4)[2];
    return [_e5, _e6, _e7];
}

pub fn row_sum_size(m: &mut Memory<'_>, i_a0: u32, x_a1: [f32; 3]) -> [f32; 3] {
    let r_e5 = <[f32; 6]>::load(m.terms, 9 * (i_a0 as usize));
    let y_e6 = x_a1.map(|x| x.abs());
    let _e20 = ((((r_e5)[0].abs() * (y_e6)[0]) + ((r_e5)[1].abs() * (y_e6)[1])) + ((r_e5)[2].abs() * (y_e6)[2]));
    let _e34 = ((((r_e5)[1].abs() * (y_e6)[0]) + ((r_e5)[3].abs() * (y_e6)[1])) + ((r_e5)[4].abs() * (y_e6)[2]));
    let _e48 = ((((r_e5)[2].abs() * (y_e6)[0]) + ((r_e5)[4].abs() * (y_e6)[1])) + ((r_e5)[5].abs() * (y_e6)[2]));
    return [_e20, _e34, _e48];
}

pub fn energy(m: &mut Memory<'_>, i_a0: u32) -> [f32; 4] {
    let mut before_v0: [f32; 3] = [0.0f32; 3];
    let mut between_v1: [f32; 3] = [0.0f32; 3];
    let mut size_v2: [f32; 3] = [0.0f32; 3];
    let range_e3 = <[u32; 4]>::load(m.ranges, 4 * (i_a0 as usize));
    let _e6 = <[i32; 4]>::load(m.reference, 4 * (i_a0 as usize));
    let _e10 = <[i32; 4]>::load(m.start, 4 * (i_a0 as usize));
    let own_e12 = zip(swizzle(_e6, [0, 1, 2]), swizzle(_e10, [0, 1, 2]), |x, y| x.wrapping_sub(y));
    let _e15 = <[i32; 4]>::load(m.trial, 4 * (i_a0 as usize));
    let _e19 = <[i32; 4]>::load(m.reference, 4 * (i_a0 as usize));
    let own_step_e21 = zip(swizzle(_e15, [0, 1, 2]), swizzle(_e19, [0, 1, 2]), |x, y| x.wrapping_sub(y));
    let _e25 = m.params.quantum;
    let d_e26 = own_e12.map(|x| (x as f32)).map(|x| (x * _e25));
    let _e30 = m.params.quantum;
    let u_e31 = own_step_e21.map(|x| (x as f32)).map(|x| (x * _e30));
    let mut k_v3: u32;
    k_v3 = (range_e3)[2];
    'l0: loop {
        'c0: {
            let _e43 = k_v3;
            if (_e43 < (range_e3)[3]) {
            } else {
                break 'l0;
            }
            {
                let _e47 = k_v3;
                let pair_e49 = <Pair>::load(m.pairs, 2 * (_e47 as usize));
                let _e53 = <[i32; 4]>::load(m.reference, 4 * ((pair_e49).node as usize));
                let at_e54 = swizzle(_e53, [0, 1, 2]);
                let _e58 = <[i32; 4]>::load(m.start, 4 * ((pair_e49).node as usize));
                let _e65 = m.params.quantum;
                let x_e68 = zip(zip(at_e54, swizzle(_e58, [0, 1, 2]), |x, y| x.wrapping_sub(y)), own_e12, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * (_e65 * (pair_e49).value)));
                let _e72 = <[i32; 4]>::load(m.trial, 4 * ((pair_e49).node as usize));
                let _e79 = m.params.quantum;
                let y_e82 = zip(zip(swizzle(_e72, [0, 1, 2]), at_e54, |x, y| x.wrapping_sub(y)), own_step_e21, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * (_e79 * (pair_e49).value)));
                let _e83 = before_v0;
                before_v0 = zip(_e83, x_e68, |x, y| (x + y));
                let _e85 = between_v1;
                between_v1 = zip(_e85, zip(x_e68, y_e82.map(|x| (0.5f32 * x)), |x, y| (x + y)), |x, y| (x + y));
                let _e90 = size_v2;
                size_v2 = zip(_e90, zip(x_e68.map(|x| x.abs()), y_e82.map(|x| x.abs()), |x, y| (x + y)), |x, y| (x + y));
            }
        }
        let _e95 = k_v3;
        k_v3 = _e95.wrapping_add(1u32);
    }
    let c_e98 = linear_term(m, i_a0);
    let middle_e101 = zip(d_e26, u_e31.map(|x| (0.5f32 * x)), |x, y| (x + y));
    let _e102 = row_sum_times(m, i_a0, d_e26);
    let _e103 = before_v0;
    let _e108 = dot(d_e26, zip(zip(_e102, _e103, |x, y| (x + y)).map(|x| (0.5f32 * x)), c_e98, |x, y| (x + y)));
    let _e109 = row_sum_times(m, i_a0, middle_e101);
    let _e110 = between_v1;
    let _e113 = dot(u_e31, zip(zip(_e109, _e110, |x, y| (x + y)), c_e98, |x, y| (x + y)));
    let _e118 = row_sum_size(m, i_a0, zip(d_e26.map(|x| x.abs()), u_e31.map(|x| x.abs()), |x, y| (x + y)));
    let _e119 = size_v2;
    let _e123 = dot(u_e31.map(|x| x.abs()), zip(zip(_e118, _e119, |x, y| (x + y)), c_e98.map(|x| x.abs()), |x, y| (x + y)));
    let _e125 = part([_e108, _e113, _e123]);
    return _e125;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut sum_v0: [[f32; 4]; 64] = [[0.0f32; 4]; 64];
    let mut _e29: [[f32; 4]; 64] = [[0.0f32; 4]; 64];
    for t in 0..64 {
        let mut i_v1: u32;
        i_v1 = 64u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(([t as u32, 0, 0])[0]);
        'l0: loop {
            'c0: {
                let _e11 = i_v1;
                let _e14 = m.params.count;
                if (_e11 < _e14) {
                } else {
                    break 'l0;
                }
                {
                    let _e16 = sum_v0[t];
                    let _e17 = i_v1;
                    let _e18 = energy(m, _e17);
                    sum_v0[t] = zip(_e16, _e18, |x, y| (x + y));
                }
            }
            let _e20 = i_v1;
            let _e24 = m.params.workgroups;
            i_v1 = _e20.wrapping_add(64u32.wrapping_mul(_e24));
        }
        _e29[t] = sum_v0[t];
    }
    put_part(m, std::array::from_fn::<_, 64, _>(|t| ([group, 0, 0])[0]), std::array::from_fn::<_, 64, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 64, _>(|t| _e29[t]));
}

pub fn run(bound: Bound<'_>) {
    let ranges = bound.read(0);
    let pairs = bound.read(1);
    let terms = bound.read(2);
    let reference = bound.read(3);
    let trial = bound.read(4);
    let start = bound.read(5);
    let mut parts = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        ranges: &ranges,
        pairs: &pairs,
        terms: &terms,
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
