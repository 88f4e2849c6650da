// Written from `shader/call/warm_start.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "warm_start",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/call/warm_start.wgsl"),
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
    pub carried: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::warm_start::*;
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
    carried: &'a [u32],
    candidates: &'a [u32],
    states: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn ordered(candidate_a0: Candidate) -> Candidate {
    let kind_e3 = (candidate_a0).kind_and_a.wrapping_shr(29u32);
    let a_e6 = ((candidate_a0).kind_and_a & 536870911u32);
    let mut local_v0: bool;
    if (!(kind_e3 == 0u32)) {
        local_v0 = (kind_e3 == 3u32);
    } else {
        local_v0 = true;
    }
    let _e15 = local_v0;
    let mut local_v1: bool;
    if _e15 {
        local_v1 = ((candidate_a0).b < a_e6);
    } else {
        local_v1 = false;
    }
    let _e21 = local_v1;
    if _e21 {
        let _e25 = (kind_e3.wrapping_shl(29u32) | (candidate_a0).b);
        return Candidate { kind_and_a: _e25, b: a_e6 };
    }
    return candidate_a0;
}

pub fn place_of(m: &mut Memory<'_>, pair_a0: Candidate) -> u32 {
    let mut low_v0: u32 = 0u32;
    let _e5 = m.params.carried;
    let mut high_v1: u32;
    high_v1 = _e5;
    'l0: loop {
        'c0: {
            let _e7 = low_v0;
            let _e8 = high_v1;
            if (_e7 < _e8) {
            } else {
                break 'l0;
            }
            {
                let _e10 = low_v0;
                let _e11 = high_v1;
                let middle_e14 = (_e10.wrapping_add(_e11) / 2u32);
                let found_e18 = <Candidate>::load(m.carried, 8 * (middle_e14 as usize) + 4);
                let mut local_v2: bool;
                if ((found_e18).kind_and_a == (pair_a0).kind_and_a) {
                    local_v2 = ((found_e18).b == (pair_a0).b);
                } else {
                    local_v2 = false;
                }
                let _e28 = local_v2;
                if _e28 {
                    return middle_e14;
                }
                let mut local_v3: bool;
                if (!((found_e18).kind_and_a < (pair_a0).kind_and_a)) {
                    let mut local_v4: bool;
                    if ((found_e18).kind_and_a == (pair_a0).kind_and_a) {
                        local_v4 = ((found_e18).b < (pair_a0).b);
                    } else {
                        local_v4 = false;
                    }
                    let _e44 = local_v4;
                    local_v3 = _e44;
                } else {
                    local_v3 = true;
                }
                let _e46 = local_v3;
                if _e46 {
                    low_v0 = middle_e14.wrapping_add(1u32);
                } else {
                    high_v1 = middle_e14;
                }
            }
        }
    }
    return 4294967295u32;
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
                let _e15 = <Candidate>::load(m.candidates, 2 * (_e13 as usize));
                let pair_e16 = ordered(_e15);
                let place_e17 = place_of(m, pair_e16);
                if (place_e17 == 4294967295u32) {
                    break 'c0;
                }
                let _e22 = c_v0;
                let _e25 = <u32>::load(m.candidates, 2 * (_e22 as usize));
                let swapped_e26 = ((pair_e16).kind_and_a != _e25);
                let friction_e30 = <[f32; 3]>::load(m.carried, 8 * (place_e17 as usize));
                let _e32 = c_v0;
                Stored::store((if swapped_e26 { friction_e30.map(|x| (-x)) } else { friction_e30 }), m.states, 8 * (_e32 as usize));
                let _e38 = c_v0;
                let _e44 = <f32>::load(m.carried, 8 * (place_e17 as usize) + 3);
                Stored::store(_e44, m.states, 8 * (_e38 as usize) + 3);
            }
        }
        let _e45 = c_v0;
        c_v0 = _e45.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let carried = bound.read(0);
    let candidates = bound.read(1);
    let mut states = bound.write(2);
    let mut control = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        carried: &carried,
        candidates: &candidates,
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
