// Written from `shader/search/inherit_states.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "inherit_states",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/search/inherit_states.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write, Write],
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
use crate::kernels::inherit_states::*;
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
    old_rows: &'a [u32],
    old_elements: &'a [u32],
    old_states: &'a [u32],
    states: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 0);
    if (_e3 == 0u32) {
        return;
    }
    let mut row_v0: u32;
    row_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = row_v0;
            let _e11 = m.params.rows;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e14 = row_v0;
                let old_e16 = <OldRow>::load(m.old_rows, 2 * (_e14 as usize));
                let _e18 = row_v0;
                let _e20 = <u32>::load(m.starts, 1 * (_e18 as usize));
                let mut c_v1: u32;
                c_v1 = _e20;
                'l1: loop {
                    'c1: {
                        let _e22 = c_v1;
                        let _e24 = row_v0;
                        let _e28 = <u32>::load(m.starts, 1 * (_e24.wrapping_add(1u32) as usize));
                        let _e31 = m.params.capacity;
                        if (_e22 < _e28.min(_e31)) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e35 = c_v1;
                            let element_e38 = <u32>::load(m.candidates, 2 * (_e35 as usize) + 1);
                            let _e40 = [0.0f32; 3];
                            let mut state_v2: PairState;
                            state_v2 = PairState { friction: _e40, multiplier: 0.0f32, desired: (-1.0f32), min_separation: 0.0f32, range: 0.0f32, is_far: 0u32 };
                            let mut place_v3: u32;
                            place_v3 = (old_e16).first;
                            'l2: loop {
                                'c2: {
                                    let _e50 = place_v3;
                                    if (_e50 < (old_e16).first.wrapping_add((old_e16).count)) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e56 = place_v3;
                                        let _e58 = <u32>::load(m.old_elements, 1 * (_e56 as usize));
                                        if (_e58 == element_e38) {
                                            let _e61 = place_v3;
                                            let _e63 = <PairState>::load(m.old_states, 8 * (_e61 as usize));
                                            state_v2 = _e63;
                                            break 'l2;
                                        }
                                    }
                                }
                                let _e64 = place_v3;
                                place_v3 = _e64.wrapping_add(1u32);
                            }
                            let _e68 = c_v1;
                            let _e70 = state_v2;
                            Stored::store(_e70, m.states, 8 * (_e68 as usize));
                        }
                    }
                    let _e71 = c_v1;
                    c_v1 = _e71.wrapping_add(1u32);
                }
            }
        }
        let _e74 = row_v0;
        row_v0 = _e74.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let starts = bound.read(0);
    let candidates = bound.read(1);
    let old_rows = bound.read(2);
    let old_elements = bound.read(3);
    let old_states = bound.read(4);
    let mut states = bound.write(5);
    let mut control = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        starts: &starts,
        candidates: &candidates,
        old_rows: &old_rows,
        old_elements: &old_elements,
        old_states: &old_states,
        states: &mut states,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
