// Written from `shader/elements/strand_gradient.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "strand_gradient",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/gradients.wgsl"),
        include_str!("../../shader/shared/strand.wgsl"),
        include_str!("../../shader/elements/strand_gradient.wgsl"),
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
use crate::kernels::strand_gradient::*;
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
    params: GradientParams,
    strands: &'a [u32],
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

pub fn is_edge(strand_a0: Strand) -> bool {
    return (((strand_a0).nodes)[0] == ((strand_a0).nodes)[1]);
}

pub fn jump_of(strand_a0: Strand, first_a1: [f32; 3], second_a2: [f32; 3]) -> [f32; 3] {
    return zip(second_a2.map(|x| (x * ((strand_a0).inverse_lengths)[1])), first_a1.map(|x| (x * ((strand_a0).inverse_lengths)[0])), |x, y| (x - y));
}

pub fn along_of(strand_a0: Strand, w_a1: [f32; 3], size_a2: f32) -> [f32; 3] {
    if (size_a2 > 0.0f32) {
        return zip(w_a1, [size_a2; 3], |x, y| (x / y));
    }
    let _e7 = is_edge(strand_a0);
    let _e10 = (if _e7 { 1.0f32 } else { 0.0f32 });
    return [_e10, 0.0f32, 0.0f32];
}

pub fn weights_of(strand_a0: Strand) -> [f32; 3] {
    let a_e2 = ((strand_a0).inverse_lengths)[0];
    let c_e4 = ((strand_a0).inverse_lengths)[1];
    let _e6 = (-(a_e2 + c_e4));
    return [a_e2, _e6, c_e4];
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
                let strand_e11 = <Strand>::load(m.strands, 8 * (_e9 as usize));
                let n_e12 = (strand_e11).nodes;
                let _e15 = way(m, (n_e12)[0], (n_e12)[1]);
                let _e18 = way(m, (n_e12)[1], (n_e12)[2]);
                let w_e19 = jump_of(strand_e11, _e15, _e18);
                let size_e20 = dot(w_e19, w_e19).sqrt();
                let _e21 = along_of(strand_e11, w_e19, size_e20);
                let mut force_v1: [f32; 3];
                force_v1 = _e21.map(|x| (x * (size_e20 - (strand_e11).rest)));
                let mut local_v2: bool;
                if ((strand_e11).damping > 0.0f32) {
                    let _e33 = m.params.rate;
                    local_v2 = (_e33 > 0.0f32);
                } else {
                    local_v2 = false;
                }
                let _e37 = local_v2;
                if _e37 {
                    let _e41 = m.params.rate;
                    let factor_e42 = ((strand_e11).damping * _e41);
                    let _e45 = moved(m, (n_e12)[0], (n_e12)[1]);
                    let _e48 = moved(m, (n_e12)[1], (n_e12)[2]);
                    let turned_e49 = jump_of(strand_e11, _e45, _e48);
                    let _e50 = is_edge(strand_e11);
                    if _e50 {
                        let _e51 = force_v1;
                        force_v1 = zip(_e51, w_e19.map(|x| (x * ((0.5f32 * factor_e42) * dot(turned_e49, zip(w_e19.map(|x| (2.0f32 * x)), turned_e49, |x, y| (x - y)))))), |x, y| (x + y));
                    } else {
                        let _e61 = force_v1;
                        force_v1 = zip(_e61, turned_e49.map(|x| (x * factor_e42)), |x, y| (x + y));
                    }
                }
                let _e64 = force_v1;
                force_v1 = _e64.map(|x| (x * (strand_e11).stiffness));
                let weights_e67 = weights_of(strand_e11);
                let _e69 = e_v0;
                let _e71 = force_v1;
                put(m, 3u32.wrapping_mul(_e69), _e71.map(|x| (x * (weights_e67)[0])));
                let _e75 = e_v0;
                let _e79 = force_v1;
                put(m, 3u32.wrapping_mul(_e75).wrapping_add(1u32), _e79.map(|x| (x * (weights_e67)[1])));
                let _e83 = e_v0;
                let _e87 = force_v1;
                put(m, 3u32.wrapping_mul(_e83).wrapping_add(2u32), _e87.map(|x| (x * (weights_e67)[2])));
            }
        }
        let _e90 = e_v0;
        e_v0 = _e90.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let strands = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut gradients = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        strands: &strands,
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
