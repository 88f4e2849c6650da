// Written from `shader/search/near_planes.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "near_planes",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/near_planes.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Write, Write, Write],
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
pub const POINT_ROUNDING: f32 = 1.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub queries: u32,
    pub planes: u32,
    pub first_row: u32,
    pub lists: u32,
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::near_planes::*;
use crate::wgsl::*;

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

#[derive(Clone, Copy)]
pub struct Slot {
    pub v0: u32,
    pub v1: u32,
    pub v2: u32,
    pub element: u32,
}

impl Slot {
    const ZERO: Self = Self {
        v0: 0u32,
        v1: 0u32,
        v2: 0u32,
        element: 0u32,
    };
}

impl Stored for Slot {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            v0: <u32>::load(words, at + 0),
            v1: <u32>::load(words, at + 1),
            v2: <u32>::load(words, at + 2),
            element: <u32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.v0.store(words, at + 0);
        self.v1.store(words, at + 1);
        self.v2.store(words, at + 2);
        self.element.store(words, at + 3);
    }
}

#[derive(Clone, Copy)]
pub struct Candidate {
    pub kind_and_a: u32,
    pub b: u32,
}

impl Candidate {
    const ZERO: Self = Self {
        kind_and_a: 0u32,
        b: 0u32,
    };
}

impl Stored for Candidate {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            kind_and_a: <u32>::load(words, at + 0),
            b: <u32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.kind_and_a.store(words, at + 0);
        self.b.store(words, at + 1);
    }
}

#[derive(Clone, Copy)]
pub struct Plane {
    pub normal: [f32; 3],
    pub rounding: f32,
    pub point: [i32; 3],
    pub padding: u32,
}

impl Plane {
    const ZERO: Self = Self {
        normal: [0.0f32; 3],
        rounding: 0.0f32,
        point: [0i32; 3],
        padding: 0u32,
    };
}

impl Stored for Plane {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            normal: <[f32; 3]>::load(words, at + 0),
            rounding: <f32>::load(words, at + 3),
            point: <[i32; 3]>::load(words, at + 4),
            padding: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.normal.store(words, at + 0);
        self.rounding.store(words, at + 3);
        self.point.store(words, at + 4);
        self.padding.store(words, at + 7);
    }
}

struct Memory<'a> {
    params: Params,
    queries: &'a [u32],
    planes: &'a [u32],
    balls: &'a [u32],
    vertices: &'a [u32],
    starts: &'a mut [u32],
    candidates: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 0);
    if (_e3 == 0u32) {
        return;
    }
    let mut q_v0: u32;
    q_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = q_v0;
            let _e11 = m.params.queries;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e15 = m.params.first_row;
                let _e16 = q_v0;
                let row_e17 = _e15.wrapping_add(_e16);
                let _e19 = q_v0;
                let query_e21 = <Slot>::load(m.queries, 4 * (_e19 as usize));
                let mut first_v1: u32;
                first_v1 = 0u32;
                let _e26 = m.params.lists;
                if (_e26 != 0u32) {
                    let _e31 = <u32>::load(m.starts, 1 * (row_e17 as usize));
                    first_v1 = _e31;
                }
                let mut found_v2: u32;
                found_v2 = 0u32;
                let mut local_v3: bool;
                if ((query_e21).element != 4294967295u32) {
                    let _e43 = <u32>::load(m.vertices, 12 * ((query_e21).v0 as usize) + 3);
                    local_v3 = ((_e43 & 1u32) == 0u32);
                } else {
                    local_v3 = false;
                }
                let _e49 = local_v3;
                if _e49 {
                    let ball_e53 = <Ball>::load(m.balls, 4 * ((query_e21).v0 as usize));
                    let _e60 = <f32>::load(m.vertices, 12 * ((query_e21).v0 as usize) + 1);
                    let reach_e63 = (((ball_e53).radius as f32) + (2.0f32 * _e60));
                    let mut p_v4: u32;
                    p_v4 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e66 = p_v4;
                            let _e69 = m.params.planes;
                            if (_e66 < _e69) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e72 = p_v4;
                                let plane_e74 = <Plane>::load(m.planes, 8 * (_e72 as usize));
                                let offset_e78 = zip((ball_e53).center, (plane_e74).point, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                                let height_e80 = dot((plane_e74).normal, offset_e78);
                                let size_e88 = (offset_e78)[0].abs().max((offset_e78)[1].abs()).max((offset_e78)[2].abs());
                                if ((height_e80 - ((plane_e74).rounding * size_e88)) <= ((reach_e63 * 1.001f32) + 1.0f32)) {
                                    let _e99 = m.params.lists;
                                    let mut local_v5: bool;
                                    if (_e99 != 0u32) {
                                        let _e104 = first_v1;
                                        let _e107 = m.params.capacity;
                                        local_v5 = (_e104 < _e107);
                                    } else {
                                        local_v5 = false;
                                    }
                                    let _e110 = local_v5;
                                    let mut local_v6: bool;
                                    if _e110 {
                                        let _e113 = found_v2;
                                        let _e116 = m.params.capacity;
                                        let _e117 = first_v1;
                                        local_v6 = (_e113 < _e116.wrapping_sub(_e117));
                                    } else {
                                        local_v6 = false;
                                    }
                                    let _e121 = local_v6;
                                    if _e121 {
                                        let _e123 = first_v1;
                                        let _e124 = found_v2;
                                        let _e129 = (2147483648u32 | (query_e21).element);
                                        let _e130 = p_v4;
                                        Stored::store(Candidate { kind_and_a: _e129, b: _e130 }, m.candidates, 2 * (_e123.wrapping_add(_e124) as usize));
                                    }
                                    let _e132 = found_v2;
                                    found_v2 = _e132.wrapping_add(1u32);
                                }
                            }
                        }
                        let _e135 = p_v4;
                        p_v4 = _e135.wrapping_add(1u32);
                    }
                }
                let _e140 = m.params.lists;
                if (_e140 == 0u32) {
                    let _e145 = found_v2;
                    Stored::store(_e145, m.starts, 1 * (row_e17 as usize));
                }
            }
        }
        let _e146 = q_v0;
        q_v0 = _e146.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let queries = bound.read(0);
    let planes = bound.read(1);
    let balls = bound.read(2);
    let vertices = bound.read(3);
    let mut starts = bound.write(4);
    let mut candidates = bound.write(5);
    let mut control = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        queries: &queries,
        planes: &planes,
        balls: &balls,
        vertices: &vertices,
        starts: &mut starts,
        candidates: &mut candidates,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
