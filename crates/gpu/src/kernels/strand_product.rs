// Written from `shader/linear/strand_product.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "strand_product",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/strand.wgsl"),
        include_str!("../../shader/linear/strand_product.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::strand_product::*;
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

#[derive(Clone, Copy)]
pub struct Curvature {
    pub along: [f32; 3],
    pub axial: f32,
    pub across: f32,
}

impl Curvature {
    const ZERO: Self = Self {
        along: [0.0f32; 3],
        axial: 0.0f32,
        across: 0.0f32,
    };
}

impl Stored for Curvature {
    const WORDS: usize = 5;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            along: <[f32; 3]>::load(words, at + 0),
            axial: <f32>::load(words, at + 3),
            across: <f32>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.along.store(words, at + 0);
        self.axial.store(words, at + 3);
        self.across.store(words, at + 4);
    }
}

struct Memory<'a> {
    params: Params,
    strands: &'a [u32],
    curvatures: &'a [u32],
    rows: &'a [u32],
    direction: &'a [u32],
    image: &'a mut [u32],
    progress: &'a mut [u32],
}

pub fn jump_of(strand_a0: Strand, first_a1: [f32; 3], second_a2: [f32; 3]) -> [f32; 3] {
    return zip(second_a2.map(|x| (x * ((strand_a0).inverse_lengths)[1])), first_a1.map(|x| (x * ((strand_a0).inverse_lengths)[0])), |x, y| (x - y));
}

pub fn weights_of(strand_a0: Strand) -> [f32; 3] {
    let a_e2 = ((strand_a0).inverse_lengths)[0];
    let c_e4 = ((strand_a0).inverse_lengths)[1];
    let _e6 = (-(a_e2 + c_e4));
    return [a_e2, _e6, c_e4];
}

pub fn product(m: &mut Memory<'_>, e_a0: u32) -> [f32; 3] {
    let strand_e3 = <Strand>::load(m.strands, 8 * (e_a0 as usize));
    let _e8 = <[f32; 4]>::load(m.direction, 4 * (((strand_e3).nodes)[1] as usize));
    let middle_e9 = swizzle(_e8, [0, 1, 2]);
    let _e14 = <[f32; 4]>::load(m.direction, 4 * (((strand_e3).nodes)[0] as usize));
    let _e21 = <[f32; 4]>::load(m.direction, 4 * (((strand_e3).nodes)[2] as usize));
    let w_e24 = jump_of(strand_e3, zip(middle_e9, swizzle(_e14, [0, 1, 2]), |x, y| (x - y)), zip(swizzle(_e21, [0, 1, 2]), middle_e9, |x, y| (x - y)));
    let curvature_e27 = <Curvature>::load(m.curvatures, 5 * (e_a0 as usize));
    let _e29 = ((curvature_e27).along)[0];
    let _e31 = ((curvature_e27).along)[1];
    let _e33 = ((curvature_e27).along)[2];
    let along_e34 = [_e29, _e31, _e33];
    return zip(w_e24.map(|x| (x * (curvature_e27).across)), along_e34.map(|x| (x * ((curvature_e27).axial * dot(along_e34, w_e24)))), |x, y| (x + y));
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.progress, 0);
    if (_e3 == 0u32) {
        return;
    }
    let mut k_v0: u32;
    k_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = k_v0;
            let _e11 = m.params.rows;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let mut sum_v1: [f32; 3];
                sum_v1 = [0.0f32; 3];
                let _e18 = k_v0;
                let _e23 = <u32>::load(m.rows, 1 * (3u32.wrapping_mul(_e18).wrapping_add(1u32) as usize));
                let mut at_v2: u32;
                at_v2 = _e23;
                'l1: loop {
                    'c1: {
                        let _e25 = at_v2;
                        let _e28 = k_v0;
                        let _e33 = <u32>::load(m.rows, 1 * (3u32.wrapping_mul(_e28).wrapping_add(2u32) as usize));
                        if (_e25 < _e33) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e36 = at_v2;
                            let entry_e38 = <u32>::load(m.rows, 1 * (_e36 as usize));
                            let _e39 = sum_v1;
                            let _e42 = product(m, (entry_e38 / 3u32));
                            let _e47 = <Strand>::load(m.strands, 8 * ((entry_e38 / 3u32) as usize));
                            let _e48 = weights_of(_e47);
                            sum_v1 = zip(_e39, _e42.map(|x| (x * (_e48)[(entry_e38 % 3u32) as usize])), |x, y| (x + y));
                        }
                    }
                    let _e54 = at_v2;
                    at_v2 = _e54.wrapping_add(1u32);
                }
                let _e60 = k_v0;
                let _e63 = <u32>::load(m.rows, 1 * (3u32.wrapping_mul(_e60) as usize));
                let _e65 = sum_v1;
                Stored::store([(_e65)[0], (_e65)[1], (_e65)[2], 0.0f32], m.image, 4 * (_e63 as usize));
            }
        }
        let _e68 = k_v0;
        k_v0 = _e68.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let strands = bound.read(0);
    let curvatures = bound.read(1);
    let rows = bound.read(2);
    let direction = bound.read(3);
    let mut image = bound.write(4);
    let mut progress = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        strands: &strands,
        curvatures: &curvatures,
        rows: &rows,
        direction: &direction,
        image: &mut image,
        progress: &mut progress,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
