// Written from `shader/rows/friction_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "friction_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/rows/friction_rows.wgsl"),
    ],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Read, Write, Write],
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
    pub pair_frictions: u32,
    pub first_half_space: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::friction_rows::*;
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

#[derive(Clone, Copy)]
pub struct PairFriction {
    pub a: u32,
    pub b: u32,
    pub coefficient: f32,
}

impl PairFriction {
    const ZERO: Self = Self {
        a: 0u32,
        b: 0u32,
        coefficient: 0.0f32,
    };
}

impl Stored for PairFriction {
    const WORDS: usize = 3;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            a: <u32>::load(words, at + 0),
            b: <u32>::load(words, at + 1),
            coefficient: <f32>::load(words, at + 2),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.a.store(words, at + 0);
        self.b.store(words, at + 1);
        self.coefficient.store(words, at + 2);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    slip_start: &'a [u32],
    vertices: &'a [u32],
    pair_frictions: &'a [u32],
    candidates: &'a [u32],
    states: &'a [u32],
    rows: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn across(normal_a0: [f32; 3], v_a1: [f32; 3]) -> [f32; 3] {
    return zip(v_a1, normal_a0.map(|x| (x * dot(normal_a0, v_a1))), |x, y| (x - y));
}

pub fn friction_of(m: &mut Memory<'_>, one_a0: u32, other_a1: u32) -> f32 {
    let mut low_v0: u32 = 0u32;
    let _e5 = <u32>::load(m.vertices, 12 * (one_a0 as usize) + 2);
    let _e9 = <u32>::load(m.vertices, 12 * (other_a1 as usize) + 2);
    let a_e10 = _e5.min(_e9);
    let _e14 = <u32>::load(m.vertices, 12 * (one_a0 as usize) + 2);
    let _e18 = <u32>::load(m.vertices, 12 * (other_a1 as usize) + 2);
    let b_e19 = _e14.max(_e18);
    let _e24 = m.params.pair_frictions;
    let mut high_v1: u32;
    high_v1 = _e24;
    'l0: loop {
        'c0: {
            let _e26 = low_v0;
            let _e27 = high_v1;
            if (_e26 < _e27) {
            } else {
                break 'l0;
            }
            {
                let _e29 = low_v0;
                let _e30 = high_v1;
                let middle_e33 = (_e29.wrapping_add(_e30) / 2u32);
                let pair_e36 = <PairFriction>::load(m.pair_frictions, 3 * (middle_e33 as usize));
                let mut local_v2: bool;
                if ((pair_e36).a == a_e10) {
                    local_v2 = ((pair_e36).b == b_e19);
                } else {
                    local_v2 = false;
                }
                let _e44 = local_v2;
                if _e44 {
                    return (pair_e36).coefficient;
                }
                let mut local_v3: bool;
                if (!((pair_e36).a < a_e10)) {
                    let mut local_v4: bool;
                    if ((pair_e36).a == a_e10) {
                        local_v4 = ((pair_e36).b < b_e19);
                    } else {
                        local_v4 = false;
                    }
                    let _e58 = local_v4;
                    local_v3 = _e58;
                } else {
                    local_v3 = true;
                }
                let _e60 = local_v3;
                if _e60 {
                    low_v0 = middle_e33.wrapping_add(1u32);
                } else {
                    high_v1 = middle_e33;
                }
            }
        }
    }
    let _e66 = <f32>::load(m.vertices, 12 * (one_a0 as usize) + 11);
    let _e70 = <f32>::load(m.vertices, 12 * (other_a1 as usize) + 11);
    return (_e66 * _e70);
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 14);
    let _e6 = m.params.capacity;
    let count_e7 = _e3.min(_e6);
    let mut r_v0: u32;
    r_v0 = ([128 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = r_v0;
            if (_e10 < count_e7) {
            } else {
                break 'l0;
            }
            {
                let _e13 = r_v0;
                let c_e16 = <u32>::load(m.rows, 24 * (_e13 as usize) + 14);
                let _e18 = r_v0;
                let v_e21 = <[u32; 4]>::load(m.rows, 24 * (_e18 as usize));
                let candidate_e24 = <Candidate>::load(m.candidates, 2 * (c_e16 as usize));
                let kind_e27 = (candidate_e24).kind_and_a.wrapping_shr(29u32);
                let mut other_v1: u32;
                other_v1 = (v_e21)[1];
                if (kind_e27 == 4u32) {
                    let _e34 = m.params.first_half_space;
                    other_v1 = _e34.wrapping_add((candidate_e24).b);
                } else {
                    if (kind_e27 == 3u32) {
                        other_v1 = (v_e21)[2];
                    }
                }
                let mut slip_v2: [f32; 3];
                slip_v2 = [0.0f32; 3];
                let mut k_v3: u32;
                k_v3 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e45 = k_v3;
                        if (_e45 < 4u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e48 = slip_v2;
                            let _e50 = r_v0;
                            let _e53 = k_v3;
                            let _e55 = <f32>::load(m.rows, 24 * (_e50 as usize) + 4 + 1 * (_e53 as usize));
                            let _e57 = k_v3;
                            let _e60 = <[i32; 4]>::load(m.positions, 4 * ((v_e21)[_e57 as usize] as usize));
                            let _e63 = k_v3;
                            let _e66 = <[i32; 4]>::load(m.slip_start, 4 * ((v_e21)[_e63 as usize] as usize));
                            slip_v2 = zip(_e48, zip(swizzle(_e60, [0, 1, 2]), swizzle(_e66, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (_e55 * x)), |x, y| (x + y));
                        }
                    }
                    let _e72 = k_v3;
                    k_v3 = _e72.wrapping_add(1u32);
                }
                let _e76 = r_v0;
                let _e80 = other_v1;
                let _e81 = friction_of(m, (v_e21)[0], _e80);
                Stored::store(_e81, m.rows, 24 * (_e76 as usize) + 19);
                let _e83 = r_v0;
                let _e87 = r_v0;
                let _e90 = <[f32; 3]>::load(m.rows, 24 * (_e87 as usize) + 8);
                let _e91 = slip_v2;
                let _e92 = across(_e90, _e91);
                Stored::store(_e92, m.rows, 24 * (_e83 as usize) + 16);
                let _e94 = r_v0;
                let _e98 = r_v0;
                let _e101 = <[f32; 3]>::load(m.rows, 24 * (_e98 as usize) + 8);
                let _e105 = <[f32; 3]>::load(m.states, 8 * (c_e16 as usize));
                let _e106 = across(_e101, _e105);
                Stored::store(_e106, m.rows, 24 * (_e94 as usize) + 20);
            }
        }
        let _e107 = r_v0;
        r_v0 = _e107.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let slip_start = bound.read(1);
    let vertices = bound.read(2);
    let pair_frictions = bound.read(3);
    let candidates = bound.read(4);
    let states = bound.read(5);
    let mut rows = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        slip_start: &slip_start,
        vertices: &vertices,
        pair_frictions: &pair_frictions,
        candidates: &candidates,
        states: &states,
        rows: &mut rows,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
