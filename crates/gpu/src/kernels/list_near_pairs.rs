// Written from `shader/call/list_near_pairs.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "list_near_pairs",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/call/list_near_pairs.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write],
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
    pub capacity: u32,
    pub near_capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::list_near_pairs::*;
use crate::wgsl::*;

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

struct Memory<'a> {
    params: Params,
    starts: &'a [u32],
    candidates: &'a [u32],
    near: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 13);
    let _e6 = m.params.capacity;
    let count_e7 = _e3.min(_e6);
    let mut c_v0: u32;
    c_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = c_v0;
            if (_e10 < count_e7) {
            } else {
                break 'l0;
            }
            {
                let _e13 = c_v0;
                let place_e15 = <u32>::load(m.starts, 1 * (_e13 as usize));
                let _e17 = c_v0;
                let _e21 = <u32>::load(m.starts, 1 * (_e17.wrapping_add(1u32) as usize));
                let mut local_v1: bool;
                if (_e21 > place_e15) {
                    let _e27 = m.params.near_capacity;
                    local_v1 = (place_e15 < _e27);
                } else {
                    local_v1 = false;
                }
                let _e30 = local_v1;
                if _e30 {
                    let _e34 = c_v0;
                    let _e36 = <Candidate>::load(m.candidates, 2 * (_e34 as usize));
                    Stored::store(_e36, m.near, 2 * (place_e15 as usize));
                }
            }
        }
        let _e37 = c_v0;
        c_v0 = _e37.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let starts = bound.read(0);
    let candidates = bound.read(1);
    let mut near = bound.write(2);
    let mut control = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        starts: &starts,
        candidates: &candidates,
        near: &mut near,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
