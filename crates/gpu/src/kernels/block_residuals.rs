// Written from `shader/forward/block_residuals.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "block_residuals",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/forward/block_residuals.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const OBSTACLE: u32 = 1u32;
pub const PRESCRIBED: u32 = 2u32;
pub const SELF_COLLIDES: u32 = 4u32;
pub const KNOWN: u32 = 8u32;
pub const ELEMENT_BITS: u32 = 29u32;
pub const ELEMENT_MASK: u32 = 536870911u32;
pub const VERTEX_VERTEX: u32 = 0u32;
pub const VERTEX_EDGE: u32 = 1u32;
pub const VERTEX_TRIANGLE: u32 = 2u32;
pub const EDGE_EDGE: u32 = 3u32;
pub const VERTEX_HALF_SPACE: u32 = 4u32;
pub const COLORS: u32 = 128u32;
pub const FIXED: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::block_residuals::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Block {
    pub first: u32,
    pub count: u32,
    pub body: u32,
}

impl Block {
    const ZERO: Self = Self {
        first: 0u32,
        count: 0u32,
        body: 0u32,
    };
}

impl Stored for Block {
    const WORDS: usize = 3;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            first: <u32>::load(words, at + 0),
            count: <u32>::load(words, at + 1),
            body: <u32>::load(words, at + 2),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.first.store(words, at + 0);
        self.count.store(words, at + 1);
        self.body.store(words, at + 2);
    }
}

#[derive(Clone, Copy)]
pub struct BlockSum {
    pub residual: [f32; 3],
    pub mass: f32,
    pub lengths: f32,
    pub padding_0: u32,
    pub padding_1: u32,
    pub padding_2: u32,
}

impl BlockSum {
    const ZERO: Self = Self {
        residual: [0.0f32; 3],
        mass: 0.0f32,
        lengths: 0.0f32,
        padding_0: 0u32,
        padding_1: 0u32,
        padding_2: 0u32,
    };
}

impl Stored for BlockSum {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            residual: <[f32; 3]>::load(words, at + 0),
            mass: <f32>::load(words, at + 3),
            lengths: <f32>::load(words, at + 4),
            padding_0: <u32>::load(words, at + 5),
            padding_1: <u32>::load(words, at + 6),
            padding_2: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.residual.store(words, at + 0);
        self.mass.store(words, at + 3);
        self.lengths.store(words, at + 4);
        self.padding_0.store(words, at + 5);
        self.padding_1.store(words, at + 6);
        self.padding_2.store(words, at + 7);
    }
}

struct Memory<'a> {
    params: Params,
    blocks: &'a [u32],
    positions: &'a [u32],
    aims: &'a [u32],
    displacements: &'a [u32],
    vertices: &'a [u32],
    sums: &'a mut [u32],
    shared_sums: [BlockSum; 256],
}

pub fn of_vertex(m: &mut Memory<'_>, v_a0: u32) -> BlockSum {
    let displacement_e3 = <[f32; 4]>::load(m.displacements, 4 * (v_a0 as usize));
    if ((displacement_e3)[3] == 0.0f32) {
        let _e8 = [0.0f32; 3];
        return BlockSum { residual: _e8, mass: 0.0f32, lengths: 0.0f32, padding_0: 0u32, padding_1: 0u32, padding_2: 0u32 };
    }
    let mass_e18 = <f32>::load(m.vertices, 12 * (v_a0 as usize) + 10);
    let share_e26 = ((1.0f32 / ((displacement_e3)[3] * mass_e18)) - 1.0f32).max(0.0f32);
    let _e31 = <[i32; 4]>::load(m.aims, 4 * (v_a0 as usize));
    let _e35 = <[i32; 4]>::load(m.positions, 4 * (v_a0 as usize));
    let residual_e39 = zip(swizzle(displacement_e3, [0, 1, 2]).map(|x| (x * share_e26)), zip(swizzle(_e31, [0, 1, 2]), swizzle(_e35, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)), |x, y| (x + y));
    let _e40 = residual_e39.map(|x| (x * mass_e18));
    let _e43 = (mass_e18 * dot(residual_e39, residual_e39).sqrt());
    return BlockSum { residual: _e40, mass: mass_e18, lengths: _e43, padding_0: 0u32, padding_1: 0u32, padding_2: 0u32 };
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut sum_v0: [BlockSum; 256] = [BlockSum { residual: [0.0f32; 3], mass: 0.0f32, lengths: 0.0f32, padding_0: 0u32, padding_1: 0u32, padding_2: 0u32 }; 256];
    let mut reach_v1: u32 = 128u32;
    let _e7 = [0.0f32; 3];
    for t in 0..256 {
        let block_e5 = <Block>::load(m.blocks, 3 * (([group, 0, 0])[0] as usize));
        if (([t as u32, 0, 0])[0] < (block_e5).count) {
            let _e21 = of_vertex(m, (block_e5).first.wrapping_add(([t as u32, 0, 0])[0]));
            sum_v0[t] = _e21;
        }
        let _e25 = sum_v0[t];
        m.shared_sums[([t as u32, 0, 0])[0] as usize] = _e25;
    }
    'l0: loop {
        'c0: {
            let _e28 = reach_v1;
            if (_e28 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e32 = reach_v1;
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] < _e32) {
                        let _e36 = reach_v1;
                        let other_e39 = m.shared_sums[([t as u32, 0, 0])[0].wrapping_add(_e36) as usize];
                        let _e44 = m.shared_sums[([t as u32, 0, 0])[0] as usize].residual;
                        m.shared_sums[([t as u32, 0, 0])[0] as usize].residual = zip(_e44, (other_e39).residual, |x, y| (x + y));
                        let _e51 = m.shared_sums[([t as u32, 0, 0])[0] as usize].mass;
                        m.shared_sums[([t as u32, 0, 0])[0] as usize].mass = (_e51 + (other_e39).mass);
                        let _e58 = m.shared_sums[([t as u32, 0, 0])[0] as usize].lengths;
                        m.shared_sums[([t as u32, 0, 0])[0] as usize].lengths = (_e58 + (other_e39).lengths);
                    }
                }
            }
        }
        let _e61 = reach_v1;
        reach_v1 = (_e61 / 2u32);
    }
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e72 = m.shared_sums[0];
            Stored::store(_e72, m.sums, 8 * (([group, 0, 0])[0] as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let blocks = bound.read(0);
    let positions = bound.read(1);
    let aims = bound.read(2);
    let displacements = bound.read(3);
    let vertices = bound.read(4);
    let mut sums = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        blocks: &blocks,
        positions: &positions,
        aims: &aims,
        displacements: &displacements,
        vertices: &vertices,
        sums: &mut sums,
        shared_sums: [BlockSum::ZERO; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [BlockSum::ZERO; 256];
        main(&mut m, group as u32);
    }
}
}
