// Written from `shader/search/refit_boxes.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "refit_boxes",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/refit_boxes.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Write, Write],
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
    pub first: u32,
    pub nodes: u32,
    pub first_child: u32,
    pub children: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::refit_boxes::*;
use crate::wgsl::*;

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
    boxes: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 0);
    if (_e3 == 0u32) {
        return;
    }
    let mut n_v0: u32;
    n_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = n_v0;
            let _e11 = m.params.nodes;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e16 = m.params.first_child;
                let _e18 = n_v0;
                let _e22 = <NodeBox>::load(m.boxes, 8 * (_e16.wrapping_add(8u32.wrapping_mul(_e18)) as usize));
                let mut box_v1: NodeBox;
                box_v1 = _e22;
                let _e25 = n_v0;
                let _e31 = m.params.children;
                let end_e32 = 8u32.wrapping_mul(_e25).wrapping_add(8u32).min(_e31);
                let _e34 = n_v0;
                let mut child_v2: u32;
                child_v2 = 8u32.wrapping_mul(_e34).wrapping_add(1u32);
                'l1: loop {
                    'c1: {
                        let _e39 = child_v2;
                        if (_e39 < end_e32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e44 = m.params.first_child;
                            let _e45 = child_v2;
                            let other_e48 = <NodeBox>::load(m.boxes, 8 * (_e44.wrapping_add(_e45) as usize));
                            let _e50 = box_v1.low;
                            let _e52 = zip(_e50, (other_e48).low, |x, y| x.min(y));
                            let _e54 = box_v1.deformable;
                            let _e56 = (_e54 | (other_e48).deformable);
                            let _e58 = box_v1.high;
                            let _e60 = zip(_e58, (other_e48).high, |x, y| x.max(y));
                            box_v1 = NodeBox { low: _e52, deformable: _e56, high: _e60, padding: 0u32 };
                        }
                    }
                    let _e63 = child_v2;
                    child_v2 = _e63.wrapping_add(1u32);
                }
                let _e69 = m.params.first;
                let _e70 = n_v0;
                let _e73 = box_v1;
                Stored::store(_e73, m.boxes, 8 * (_e69.wrapping_add(_e70) as usize));
            }
        }
        let _e74 = n_v0;
        n_v0 = _e74.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let mut boxes = bound.write(0);
    let mut control = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
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
