// Written from `shader/call/begin_call.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "begin_call",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/call/begin_call.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write, Write, Write, Read],
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
pub const START_SHARE: f32 = 0.97f32;
pub const LARGEST: f32 = 3.4028235e38f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub limits: u32,
    pub slips_from_here: u32,
    pub guarded_stretch: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::begin_call::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Late {
    pub smallest: f32,
    pub idle_steps: u32,
}

impl Late {
    const ZERO: Self = Self {
        smallest: 0.0f32,
        idle_steps: 0u32,
    };
}

impl Stored for Late {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            smallest: <f32>::load(words, at + 0),
            idle_steps: <u32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.smallest.store(words, at + 0);
        self.idle_steps.store(words, at + 1);
    }
}

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
    targets: &'a [u32],
    limits: &'a mut [u32],
    aims: &'a mut [u32],
    slip_start: &'a mut [u32],
    swings: &'a mut [u32],
    late: &'a mut [u32],
    vertices: &'a [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut v_v0: u32;
    v_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e4 = v_v0;
            let _e7 = m.params.vertices;
            if (_e4 < _e7) {
            } else {
                break 'l0;
            }
            {
                let _e10 = v_v0;
                let _e13 = v_v0;
                let _e15 = <[i32; 4]>::load(m.targets, 4 * (_e13 as usize));
                Stored::store(_e15, m.aims, 4 * (_e10 as usize));
                let _e18 = m.params.slips_from_here;
                if (_e18 != 0u32) {
                    let _e22 = v_v0;
                    let _e25 = v_v0;
                    let _e27 = <[i32; 4]>::load(m.positions, 4 * (_e25 as usize));
                    Stored::store(_e27, m.slip_start, 4 * (_e22 as usize));
                }
                let _e29 = v_v0;
                Stored::store([0.0f32; 4], m.swings, 4 * (_e29 as usize));
                let _e34 = v_v0;
                Stored::store(Late { smallest: 3.4028235e38f32, idle_steps: 0u32 }, m.late, 2 * (_e34 as usize));
            }
        }
        let _e39 = v_v0;
        v_v0 = _e39.wrapping_add(16776960u32);
    }
    let mut e_v1: u32;
    e_v1 = ([256 * group + t as u32, 0, 0])[0];
    'l1: loop {
        'c1: {
            let _e43 = e_v1;
            let _e46 = m.params.limits;
            if (_e43 < _e46) {
            } else {
                break 'l1;
            }
            {
                let _e49 = e_v1;
                let edge_e51 = <EdgeLimit>::load(m.limits, 8 * (_e49 as usize));
                let _e55 = <[i32; 4]>::load(m.positions, 4 * ((edge_e51).a as usize));
                let _e60 = <[i32; 4]>::load(m.positions, 4 * ((edge_e51).b as usize));
                let along_e63 = zip(swizzle(_e55, [0, 1, 2]), swizzle(_e60, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                let _e68 = <u32>::load(m.vertices, 12 * ((edge_e51).a as usize) + 3);
                let _e73 = <u32>::load(m.vertices, 12 * ((edge_e51).b as usize) + 3);
                let is_known_e78 = (((_e68 | _e73) & 8u32) != 0u32);
                let _e81 = m.params.guarded_stretch;
                let factor_e83 = (if is_known_e78 { _e81 } else { 1.0f32 });
                let _e85 = e_v1;
                Stored::store((factor_e83 * (edge_e51).longest.max((0.97f32 * dot(along_e63, along_e63).sqrt()))), m.limits, 8 * (_e85 as usize) + 2);
                let _e96 = e_v1;
                Stored::store([0.0f32; 3], m.limits, 8 * (_e96 as usize) + 4);
            }
        }
        let _e101 = e_v1;
        e_v1 = _e101.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let targets = bound.read(1);
    let mut limits = bound.write(2);
    let mut aims = bound.write(3);
    let mut slip_start = bound.write(4);
    let mut swings = bound.write(5);
    let mut late = bound.write(6);
    let vertices = bound.read(7);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        targets: &targets,
        limits: &mut limits,
        aims: &mut aims,
        slip_start: &mut slip_start,
        swings: &mut swings,
        late: &mut late,
        vertices: &vertices,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
