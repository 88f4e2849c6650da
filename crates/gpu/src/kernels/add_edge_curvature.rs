// Written from `shader/backward/add_edge_curvature.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "add_edge_curvature",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/fixed.wgsl"),
        include_str!("../../shader/backward/add_edge_curvature.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write],
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
pub const WEIGHT_UNITS: f32 = 262144.0f32;
pub const MOST: f32 = 128.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub edges: u32,
    pub strength: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::add_edge_curvature::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct EdgeLimit {
    pub a: u32,
    pub b: u32,
    pub limit: f32,
    pub places: u32,
    pub multiplier: [f32; 3],
    pub longest: f32,
}

impl EdgeLimit {
    const ZERO: Self = Self {
        a: 0u32,
        b: 0u32,
        limit: 0.0f32,
        places: 0u32,
        multiplier: [0.0f32; 3],
        longest: 0.0f32,
    };
}

impl Stored for EdgeLimit {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            a: <u32>::load(words, at + 0),
            b: <u32>::load(words, at + 1),
            limit: <f32>::load(words, at + 2),
            places: <u32>::load(words, at + 3),
            multiplier: <[f32; 3]>::load(words, at + 4),
            longest: <f32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.a.store(words, at + 0);
        self.b.store(words, at + 1);
        self.limit.store(words, at + 2);
        self.places.store(words, at + 3);
        self.multiplier.store(words, at + 4);
        self.longest.store(words, at + 7);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    limits: &'a [u32],
    proximal: &'a mut [u32],
}

pub fn weight_units(weight_a0: f32) -> u32 {
    return ((weight_a0.max(0.0f32).min(128.0f32) * 262144.0f32) as u32);
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut e_v0: u32;
    e_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = e_v0;
            let _e6 = m.params.edges;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = e_v0;
                let edge_e11 = <EdgeLimit>::load(m.limits, 8 * (_e9 as usize));
                let pull_e15 = dot((edge_e11).multiplier, (edge_e11).multiplier).sqrt();
                if (pull_e15 > 0.0f32) {
                    let _e21 = <[i32; 4]>::load(m.positions, 4 * ((edge_e11).a as usize));
                    let _e26 = <[i32; 4]>::load(m.positions, 4 * ((edge_e11).b as usize));
                    let along_e29 = zip(swizzle(_e21, [0, 1, 2]), swizzle(_e26, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                    let length_e33 = dot(along_e29, along_e29).sqrt().max(1.0f32);
                    let _e36 = m.params.strength;
                    let units_e39 = weight_units(((_e36 * pull_e15) / length_e33));
                    { let old = <u32>::load(m.proximal, 1 * ((edge_e11).a as usize)); let new = old.wrapping_add(units_e39); Stored::store(new, m.proximal, 1 * ((edge_e11).a as usize)); old };
                    { let old = <u32>::load(m.proximal, 1 * ((edge_e11).b as usize)); let new = old.wrapping_add(units_e39); Stored::store(new, m.proximal, 1 * ((edge_e11).b as usize)); old };
                }
            }
        }
        let _e48 = e_v0;
        e_v0 = _e48.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let limits = bound.read(1);
    let mut proximal = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        limits: &limits,
        proximal: &mut proximal,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
