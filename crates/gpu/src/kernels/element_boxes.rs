// Written from `shader/search/element_boxes.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "element_boxes",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/element_boxes.wgsl"),
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub slots: u32,
    pub count: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::element_boxes::*;
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
pub struct NodeBox {
    pub low: [i32; 3],
    pub deformable: u32,
    pub high: [i32; 3],
    pub padding: u32,
}

impl NodeBox {
    const ZERO: Self = Self {
        low: [0i32; 3],
        deformable: 0u32,
        high: [0i32; 3],
        padding: 0u32,
    };
}

impl Stored for NodeBox {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            low: <[i32; 3]>::load(words, at + 0),
            deformable: <u32>::load(words, at + 3),
            high: <[i32; 3]>::load(words, at + 4),
            padding: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.low.store(words, at + 0);
        self.deformable.store(words, at + 3);
        self.high.store(words, at + 4);
        self.padding.store(words, at + 7);
    }
}

struct Memory<'a> {
    params: Params,
    slots: &'a [u32],
    balls: &'a [u32],
    vertices: &'a [u32],
    boxes: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn grown(m: &mut Memory<'_>, box_a0: NodeBox, v_a1: u32) -> NodeBox {
    let ball_e4 = <Ball>::load(m.balls, 4 * (v_a1 as usize));
    let vertex_e7 = <Vertex>::load(m.vertices, 12 * (v_a1 as usize));
    let reach_e13 = [(ball_e4).radius.wrapping_add(((vertex_e7).margin.ceil() as i32)); 3];
    let deformable_e20 = ((box_a0).deformable | 1u32.wrapping_sub(((vertex_e7).flags & 1u32)));
    let _e24 = zip((box_a0).low, zip((ball_e4).center, reach_e13, |x, y| x.wrapping_sub(y)), |x, y| x.min(y));
    let _e28 = zip((box_a0).high, zip((ball_e4).center, reach_e13, |x, y| x.wrapping_add(y)), |x, y| x.max(y));
    return NodeBox { low: _e24, deformable: deformable_e20, high: _e28, padding: 0u32 };
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 0);
    if (_e3 == 0u32) {
        return;
    }
    let mut s_v0: u32;
    s_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = s_v0;
            let _e11 = m.params.slots;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e14 = s_v0;
                let slot_e16 = <Slot>::load(m.slots, 4 * (_e14 as usize));
                let mut box_v1: NodeBox;
                box_v1 = NodeBox { low: [2147483647i32; 3], deformable: 0u32, high: [(-2147483648i32); 3], padding: 0u32 };
                if ((slot_e16).element != 4294967295u32) {
                    let _e22 = box_v1;
                    let _e24 = grown(m, _e22, (slot_e16).v0);
                    box_v1 = _e24;
                    let _e27 = m.params.count;
                    if (_e27 > 1u32) {
                        let _e30 = box_v1;
                        let _e32 = grown(m, _e30, (slot_e16).v1);
                        box_v1 = _e32;
                    }
                    let _e35 = m.params.count;
                    if (_e35 > 2u32) {
                        let _e38 = box_v1;
                        let _e40 = grown(m, _e38, (slot_e16).v2);
                        box_v1 = _e40;
                    }
                }
                let _e42 = s_v0;
                let _e44 = box_v1;
                Stored::store(_e44, m.boxes, 8 * (_e42 as usize));
            }
        }
        let _e45 = s_v0;
        s_v0 = _e45.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let slots = bound.read(0);
    let balls = bound.read(1);
    let vertices = bound.read(2);
    let mut boxes = bound.write(3);
    let mut control = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        slots: &slots,
        balls: &balls,
        vertices: &vertices,
        boxes: &mut boxes,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
