// Written from `shader/search/save_candidates.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "save_candidates",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/save_candidates.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Write, Write],
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
    pub rows: u32,
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::save_candidates::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct PairState {
    pub friction: [f32; 3],
    pub multiplier: f32,
    pub desired: f32,
    pub min_separation: f32,
    pub range: f32,
    pub is_far: u32,
}

impl PairState {
    const ZERO: Self = Self {
        friction: [0.0f32; 3],
        multiplier: 0.0f32,
        desired: 0.0f32,
        min_separation: 0.0f32,
        range: 0.0f32,
        is_far: 0u32,
    };
}

impl Stored for PairState {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            friction: <[f32; 3]>::load(words, at + 0),
            multiplier: <f32>::load(words, at + 3),
            desired: <f32>::load(words, at + 4),
            min_separation: <f32>::load(words, at + 5),
            range: <f32>::load(words, at + 6),
            is_far: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.friction.store(words, at + 0);
        self.multiplier.store(words, at + 3);
        self.desired.store(words, at + 4);
        self.min_separation.store(words, at + 5);
        self.range.store(words, at + 6);
        self.is_far.store(words, at + 7);
    }
}

#[derive(Clone, Copy)]
pub struct OldRow {
    pub first: u32,
    pub count: u32,
}

impl OldRow {
    const ZERO: Self = Self {
        first: 0u32,
        count: 0u32,
    };
}

impl Stored for OldRow {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            first: <u32>::load(words, at + 0),
            count: <u32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.first.store(words, at + 0);
        self.count.store(words, at + 1);
    }
}

struct Memory<'a> {
    params: Params,
    starts: &'a [u32],
    candidates: &'a [u32],
    states: &'a [u32],
    old_rows: &'a mut [u32],
    old_elements: &'a mut [u32],
    old_states: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 0);
    if (_e3 == 0u32) {
        return;
    }
    let _e8 = <u32>::load(m.control, 13);
    let _e11 = m.params.capacity;
    let total_e12 = _e8.min(_e11);
    let mut row_v0: u32;
    row_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e15 = row_v0;
            let _e18 = m.params.rows;
            if (_e15 < _e18) {
            } else {
                break 'l0;
            }
            {
                let _e21 = row_v0;
                let _e23 = <u32>::load(m.starts, 1 * (_e21 as usize));
                let first_e24 = _e23.min(total_e12);
                let _e26 = row_v0;
                let _e30 = <u32>::load(m.starts, 1 * (_e26.wrapping_add(1u32) as usize));
                let count_e32 = _e30.min(total_e12).wrapping_sub(first_e24);
                let _e34 = row_v0;
                Stored::store(OldRow { first: first_e24, count: count_e32 }, m.old_rows, 2 * (_e34 as usize));
                let mut k_v1: u32;
                k_v1 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e39 = k_v1;
                        if (_e39 < count_e32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e42 = k_v1;
                            let _e46 = k_v1;
                            let _e50 = <u32>::load(m.candidates, 2 * (first_e24.wrapping_add(_e46) as usize) + 1);
                            Stored::store(_e50, m.old_elements, 1 * (first_e24.wrapping_add(_e42) as usize));
                            let _e52 = k_v1;
                            let _e56 = k_v1;
                            let _e59 = <PairState>::load(m.states, 8 * (first_e24.wrapping_add(_e56) as usize));
                            Stored::store(_e59, m.old_states, 8 * (first_e24.wrapping_add(_e52) as usize));
                        }
                    }
                    let _e60 = k_v1;
                    k_v1 = _e60.wrapping_add(1u32);
                }
            }
        }
        let _e63 = row_v0;
        row_v0 = _e63.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let starts = bound.read(0);
    let candidates = bound.read(1);
    let states = bound.read(2);
    let mut old_rows = bound.write(3);
    let mut old_elements = bound.write(4);
    let mut old_states = bound.write(5);
    let mut control = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        starts: &starts,
        candidates: &candidates,
        states: &states,
        old_rows: &mut old_rows,
        old_elements: &mut old_elements,
        old_states: &mut old_states,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
