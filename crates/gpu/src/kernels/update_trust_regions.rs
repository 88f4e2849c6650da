// Written from `shader/search/update_trust_regions.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "update_trust_regions",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/update_trust_regions.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write],
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
pub const COVERED: f32 = 0.998f32;
pub const ROOM: f32 = 4096.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub all: u32,
    pub slack: f32,
    pub smallest: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::update_trust_regions::*;
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

#[derive(Clone, Copy)]
pub struct Ball {
    pub center: [i32; 3],
    pub radius: i32,
}

impl Ball {
    const ZERO: Self = Self {
        center: [0i32; 3],
        radius: 0i32,
    };
}

impl Stored for Ball {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            center: <[i32; 3]>::load(words, at + 0),
            radius: <i32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.center.store(words, at + 0);
        self.radius.store(words, at + 3);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    paths: &'a [u32],
    vertices: &'a [u32],
    balls: &'a mut [u32],
    control: &'a mut [u32],
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
                let _e11 = <[f32; 4]>::load(m.paths, 4 * (_e9 as usize));
                let path_e12 = swizzle(_e11, [0, 1, 2]);
                let _e14 = v_v0;
                let _e16 = <[i32; 4]>::load(m.positions, 4 * (_e14 as usize));
                let position_e17 = swizzle(_e16, [0, 1, 2]);
                let _e19 = v_v0;
                let ball_e21 = <Ball>::load(m.balls, 4 * (_e19 as usize));
                let start_e24 = zip(position_e17, (ball_e21).center, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                let end_e25 = zip(start_e24, path_e12, |x, y| (x + y));
                let limit_e29 = (0.998f32 * ((ball_e21).radius as f32));
                let _e32 = m.params.all;
                let mut local_v1: bool;
                if (_e32 == 0u32) {
                    local_v1 = (dot(start_e24, start_e24) <= (limit_e29 * limit_e29));
                } else {
                    local_v1 = false;
                }
                let _e41 = local_v1;
                let mut local_v2: bool;
                if _e41 {
                    local_v2 = (dot(end_e25, end_e25) <= (limit_e29 * limit_e29));
                } else {
                    local_v2 = false;
                }
                let _e48 = local_v2;
                if _e48 {
                    break 'c0;
                }
                let _e50 = v_v0;
                let vertex_e52 = <Vertex>::load(m.vertices, 12 * (_e50 as usize));
                let length_e54 = dot(path_e12, path_e12).sqrt();
                let mut radius_v3: f32;
                radius_v3 = 0.0f32;
                let mut local_v4: bool;
                if (!(length_e54 > 0.0f32)) {
                    local_v4 = (((vertex_e52).flags & 2u32) == 0u32);
                } else {
                    local_v4 = true;
                }
                let _e68 = local_v4;
                if _e68 {
                    let _e75 = m.params.slack;
                    let _e81 = m.params.smallest;
                    radius_v3 = (((0.5f32 * length_e54) / 0.99600405f32) + (_e75 * (vertex_e52).edge)).max((_e81 * (vertex_e52).edge));
                    let _e85 = radius_v3;
                    radius_v3 = (_e85 + 4096.0f32);
                }
                let _e89 = v_v0;
                let _e94 = zip(position_e17, path_e12.map(|x| (x * 0.5f32)).map(|x| (x as i32)), |x, y| x.wrapping_add(y));
                let _e95 = radius_v3;
                let _e96 = (_e95 as i32);
                Stored::store(Ball { center: _e94, radius: _e96 }, m.balls, 4 * (_e89 as usize));
                Stored::store(1u32, m.control, 0);
            }
        }
        let _e101 = v_v0;
        v_v0 = _e101.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let paths = bound.read(1);
    let vertices = bound.read(2);
    let mut balls = bound.write(3);
    let mut control = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        paths: &paths,
        vertices: &vertices,
        balls: &mut balls,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
