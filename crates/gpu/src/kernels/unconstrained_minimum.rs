// Written from `shader/backward/unconstrained_minimum.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "unconstrained_minimum",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/fixed.wgsl"),
        include_str!("../../shader/backward/unconstrained_minimum.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Read, Read],
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
pub const MOST_PROXIMAL: f32 = 100.0f32;
pub const MOST_IDLE_STEPS: u32 = 6u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::unconstrained_minimum::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Vertex {
    pub edge: f32,
    pub margin: f32,
    pub body: u32,
    pub flags: u32,
    pub groups: u32,
    pub mask: u32,
    pub group: u32,
    pub delta: f32,
    pub half_space_delta: f32,
    pub thickness: f32,
    pub mass: f32,
    pub root_of_friction: f32,
}

impl Vertex {
    const ZERO: Self = Self {
        edge: 0.0f32,
        margin: 0.0f32,
        body: 0u32,
        flags: 0u32,
        groups: 0u32,
        mask: 0u32,
        group: 0u32,
        delta: 0.0f32,
        half_space_delta: 0.0f32,
        thickness: 0.0f32,
        mass: 0.0f32,
        root_of_friction: 0.0f32,
    };
}

impl Stored for Vertex {
    const WORDS: usize = 12;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            edge: <f32>::load(words, at + 0),
            margin: <f32>::load(words, at + 1),
            body: <u32>::load(words, at + 2),
            flags: <u32>::load(words, at + 3),
            groups: <u32>::load(words, at + 4),
            mask: <u32>::load(words, at + 5),
            group: <u32>::load(words, at + 6),
            delta: <f32>::load(words, at + 7),
            half_space_delta: <f32>::load(words, at + 8),
            thickness: <f32>::load(words, at + 9),
            mass: <f32>::load(words, at + 10),
            root_of_friction: <f32>::load(words, at + 11),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.edge.store(words, at + 0);
        self.margin.store(words, at + 1);
        self.body.store(words, at + 2);
        self.flags.store(words, at + 3);
        self.groups.store(words, at + 4);
        self.mask.store(words, at + 5);
        self.group.store(words, at + 6);
        self.delta.store(words, at + 7);
        self.half_space_delta.store(words, at + 8);
        self.thickness.store(words, at + 9);
        self.mass.store(words, at + 10);
        self.root_of_friction.store(words, at + 11);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    targets: &'a [u32],
    vertices: &'a [u32],
    proximal: &'a mut [u32],
    displacements: &'a mut [u32],
    swings: &'a [u32],
    late: &'a [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut v_v0: u32;
    v_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = v_v0;
            let _e6 = m.params.vertices;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = v_v0;
                let vertex_e11 = <Vertex>::load(m.vertices, 12 * (_e9 as usize));
                let _e13 = v_v0;
                let _e15 = <[i32; 4]>::load(m.targets, 4 * (_e13 as usize));
                let _e18 = v_v0;
                let _e20 = <[i32; 4]>::load(m.positions, 4 * (_e18 as usize));
                let wanted_e23 = zip(swizzle(_e15, [0, 1, 2]), swizzle(_e20, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                if (((vertex_e11).flags & 2u32) != 0u32) {
                    let _e30 = v_v0;
                    let _e35 = v_v0;
                    let _e38 = <u32>::load(m.late, 2 * (_e35 as usize) + 1);
                    let _e41 = (if (_e38 >= 6u32) { [0.0f32; 3] } else { wanted_e23 });
                    Stored::store([(_e41)[0], (_e41)[1], (_e41)[2], 0.0f32], m.displacements, 4 * (_e30 as usize));
                } else {
                    let _e45 = v_v0;
                    let _e47 = <u32>::load(m.proximal, 1 * (_e45 as usize));
                    let _e52 = v_v0;
                    let _e55 = <f32>::load(m.swings, 4 * (_e52 as usize) + 3);
                    let damping_e60 = (((_e47 as f32) / 262144.0f32) * _e55).min((100.0f32 * (vertex_e11).mass));
                    let weight_e64 = (1.0f32 / ((vertex_e11).mass + damping_e60));
                    let _e66 = v_v0;
                    let _e70 = wanted_e23.map(|x| (x * (weight_e64 * (vertex_e11).mass)));
                    Stored::store([(_e70)[0], (_e70)[1], (_e70)[2], weight_e64], m.displacements, 4 * (_e66 as usize));
                }
                let _e73 = v_v0;
                Stored::store(0u32, m.proximal, 1 * (_e73 as usize));
            }
        }
        let _e76 = v_v0;
        v_v0 = _e76.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let targets = bound.read(1);
    let vertices = bound.read(2);
    let mut proximal = bound.write(3);
    let mut displacements = bound.write(4);
    let swings = bound.read(5);
    let late = bound.read(6);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        targets: &targets,
        vertices: &vertices,
        proximal: &mut proximal,
        displacements: &mut displacements,
        swings: &swings,
        late: &late,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
