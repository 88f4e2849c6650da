// Written from `shader/rows/linearize_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "linearize_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/fixed.wgsl"),
        include_str!("../../shader/rows/linearize_rows.wgsl"),
    ],
    workgroup: 128,
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
pub const WEIGHT_UNITS: f32 = 262144.0f32;
pub const MOST: f32 = 128.0f32;
pub const AT_VERTEX: f32 = 1e-5f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub strength: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::linearize_rows::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Separation {
    pub normal: [f32; 3],
    pub width: f32,
    pub weights: [f32; 2],
    pub distance: f32,
    pub min_separation: f32,
    pub wanted: f32,
    pub sine: f32,
    pub padding_0: u32,
    pub padding_1: u32,
}

impl Separation {
    const ZERO: Self = Self {
        normal: [0.0f32; 3],
        width: 0.0f32,
        weights: [0.0f32; 2],
        distance: 0.0f32,
        min_separation: 0.0f32,
        wanted: 0.0f32,
        sine: 0.0f32,
        padding_0: 0u32,
        padding_1: 0u32,
    };
}

impl Stored for Separation {
    const WORDS: usize = 12;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            normal: <[f32; 3]>::load(words, at + 0),
            width: <f32>::load(words, at + 3),
            weights: <[f32; 2]>::load(words, at + 4),
            distance: <f32>::load(words, at + 6),
            min_separation: <f32>::load(words, at + 7),
            wanted: <f32>::load(words, at + 8),
            sine: <f32>::load(words, at + 9),
            padding_0: <u32>::load(words, at + 10),
            padding_1: <u32>::load(words, at + 11),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.normal.store(words, at + 0);
        self.width.store(words, at + 3);
        self.weights.store(words, at + 4);
        self.distance.store(words, at + 6);
        self.min_separation.store(words, at + 7);
        self.wanted.store(words, at + 8);
        self.sine.store(words, at + 9);
        self.padding_0.store(words, at + 10);
        self.padding_1.store(words, at + 11);
    }
}

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
pub struct Row {
    pub vertices: [u32; 4],
    pub weights: [f32; 4],
    pub normal: [f32; 3],
    pub value: f32,
    pub inverse_diagonal: f32,
    pub multiplier: f32,
    pub candidate: u32,
    pub color: u32,
    pub slip: [f32; 3],
    pub coefficient: f32,
    pub friction: [f32; 3],
    pub bucket: u32,
}

impl Row {
    const ZERO: Self = Self {
        vertices: [0u32; 4],
        weights: [0.0f32; 4],
        normal: [0.0f32; 3],
        value: 0.0f32,
        inverse_diagonal: 0.0f32,
        multiplier: 0.0f32,
        candidate: 0u32,
        color: 0u32,
        slip: [0.0f32; 3],
        coefficient: 0.0f32,
        friction: [0.0f32; 3],
        bucket: 0u32,
    };
}

impl Stored for Row {
    const WORDS: usize = 24;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            vertices: <[u32; 4]>::load(words, at + 0),
            weights: <[f32; 4]>::load(words, at + 4),
            normal: <[f32; 3]>::load(words, at + 8),
            value: <f32>::load(words, at + 11),
            inverse_diagonal: <f32>::load(words, at + 12),
            multiplier: <f32>::load(words, at + 13),
            candidate: <u32>::load(words, at + 14),
            color: <u32>::load(words, at + 15),
            slip: <[f32; 3]>::load(words, at + 16),
            coefficient: <f32>::load(words, at + 19),
            friction: <[f32; 3]>::load(words, at + 20),
            bucket: <u32>::load(words, at + 23),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.vertices.store(words, at + 0);
        self.weights.store(words, at + 4);
        self.normal.store(words, at + 8);
        self.value.store(words, at + 11);
        self.inverse_diagonal.store(words, at + 12);
        self.multiplier.store(words, at + 13);
        self.candidate.store(words, at + 14);
        self.color.store(words, at + 15);
        self.slip.store(words, at + 16);
        self.coefficient.store(words, at + 19);
        self.friction.store(words, at + 20);
        self.bucket.store(words, at + 23);
    }
}

#[derive(Clone, Copy)]
pub struct Pair {
    pub kind: u32,
    pub count: u32,
    pub side_a: u32,
    pub vertices: [u32; 4],
}

impl Pair {
    const ZERO: Self = Self {
        kind: 0u32,
        count: 0u32,
        side_a: 0u32,
        vertices: [0u32; 4],
    };
}

impl Stored for Pair {
    const WORDS: usize = 7;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            kind: <u32>::load(words, at + 0),
            count: <u32>::load(words, at + 1),
            side_a: <u32>::load(words, at + 2),
            vertices: <[u32; 4]>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.kind.store(words, at + 0);
        self.count.store(words, at + 1);
        self.side_a.store(words, at + 2);
        self.vertices.store(words, at + 3);
    }
}

struct Memory<'a> {
    params: Params,
    vertices: &'a [u32],
    candidates: &'a [u32],
    separations: &'a [u32],
    states: &'a [u32],
    rows: &'a mut [u32],
    proximal: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn pair_with(kind_a0: u32, v_a1: [u32; 4]) -> Pair {
    let _e2 = (v_a1)[0];
    let _e3 = (v_a1)[1];
    let _e4 = (v_a1)[2];
    let _e5 = (v_a1)[3];
    let vertices_e6 = [_e2, _e3, _e4, _e5];
    's0: { match kind_a0 {
    0u32 => {
        return Pair { kind: kind_a0, count: 2u32, side_a: 1u32, vertices: vertices_e6 };
    }
    1u32 => {
        return Pair { kind: kind_a0, count: 3u32, side_a: 1u32, vertices: vertices_e6 };
    }
    2u32 => {
        return Pair { kind: kind_a0, count: 4u32, side_a: 1u32, vertices: vertices_e6 };
    }
    3u32 => {
        return Pair { kind: kind_a0, count: 4u32, side_a: 2u32, vertices: vertices_e6 };
    }
    _ => {
        return Pair { kind: kind_a0, count: 1u32, side_a: 1u32, vertices: vertices_e6 };
    }
    } }
    unreachable!()
}

pub fn signed_weights(pair_a0: Pair, separation_a1: Separation) -> [f32; 4] {
    let s_e3 = ((separation_a1).weights)[0];
    let t_e5 = ((separation_a1).weights)[1];
    's0: { match (pair_a0).kind {
    0u32 => {
        return [1.0f32, (-1.0f32), 0.0f32, 0.0f32];
    }
    1u32 => {
        let _e13 = (s_e3 - 1.0f32);
        let _e14 = (-s_e3);
        return [1.0f32, _e13, _e14, 0.0f32];
    }
    2u32 => {
        let _e20 = ((s_e3 + t_e5) - 1.0f32);
        let _e21 = (-s_e3);
        let _e22 = (-t_e5);
        return [1.0f32, _e20, _e21, _e22];
    }
    3u32 => {
        let _e26 = (1.0f32 - s_e3);
        let _e28 = (t_e5 - 1.0f32);
        let _e29 = (-t_e5);
        return [_e26, s_e3, _e28, _e29];
    }
    _ => {
        return [1.0f32, 0.0f32, 0.0f32, 0.0f32];
    }
    } }
    unreachable!()
}

pub fn weight_units(weight_a0: f32) -> u32 {
    return ((weight_a0.max(0.0f32).min(128.0f32) * 262144.0f32) as u32);
}

pub fn inside(weight_a0: f32) -> u32 {
    return u32::from((weight_a0.abs() > 1e-5f32));
}

pub fn radius_of(pair_a0: Pair, weights_a1: [f32; 4], gap_a2: f32, sine_a3: f32, edge_a4: f32) -> f32 {
    let mut inside_a_v0: u32 = 1u32;
    let mut inside_b_v1: u32 = 1u32;
    if ((pair_a0).kind == 4u32) {
        return edge_a4;
    } else {
        if ((pair_a0).kind == 3u32) {
            let _e16 = inside((weights_a1)[0]);
            let _e18 = inside((weights_a1)[1]);
            inside_a_v0 = _e16.wrapping_add(_e18);
            let _e21 = inside((weights_a1)[2]);
            let _e23 = inside((weights_a1)[3]);
            inside_b_v1 = _e21.wrapping_add(_e23);
        } else {
            if ((pair_a0).kind != 0u32) {
                let _e29 = inside((weights_a1)[1]);
                let _e31 = inside((weights_a1)[2]);
                let _e34 = inside((weights_a1)[3]);
                inside_b_v1 = _e29.wrapping_add(_e31).wrapping_add(_e34);
            }
        }
    }
    let _e36 = inside_a_v0;
    let mut local_v2: bool;
    if (_e36 == 2u32) {
        let _e41 = inside_b_v1;
        local_v2 = (_e41 == 2u32);
    } else {
        local_v2 = false;
    }
    let _e45 = local_v2;
    if _e45 {
        return (edge_a4 * sine_a3).max(gap_a2).min(edge_a4);
    } else {
        let _e49 = inside_b_v1;
        if (_e49 == 3u32) {
            return edge_a4;
        } else {
            let _e52 = inside_a_v0;
            let mut local_v3: bool;
            if (!(_e52 == 2u32)) {
                let _e58 = inside_b_v1;
                local_v3 = (_e58 == 2u32);
            } else {
                local_v3 = true;
            }
            let _e62 = local_v3;
            if _e62 {
                return gap_a2.min(edge_a4);
            }
        }
    }
    return gap_a2;
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
                let separation_e19 = <Separation>::load(m.separations, 12 * (c_e16 as usize));
                let state_e22 = <PairState>::load(m.states, 8 * (c_e16 as usize));
                let _e24 = r_v0;
                let v_e27 = <[u32; 4]>::load(m.rows, 24 * (_e24 as usize));
                let _e31 = <u32>::load(m.candidates, 2 * (c_e16 as usize));
                let pair_e34 = pair_with(_e31.wrapping_shr(29u32), v_e27);
                let weights_e35 = signed_weights(pair_e34, separation_e19);
                if ((state_e22).multiplier > 0.0f32) {
                    let gap_e43 = (separation_e19).distance.max((state_e22).desired).max(1.0f32);
                    let mut k_v1: u32;
                    k_v1 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e46 = k_v1;
                            if (_e46 < (pair_e34).count) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e51 = k_v1;
                                let _e55 = <f32>::load(m.vertices, 12 * ((v_e27)[_e51 as usize] as usize));
                                let radius_e56 = radius_of(pair_e34, weights_e35, gap_e43, (separation_e19).sine, _e55);
                                let _e58 = k_v1;
                                let _e63 = m.params.strength;
                                let _e66 = k_v1;
                                let _e71 = weight_units((((_e63 * (state_e22).multiplier) * (weights_e35)[_e66 as usize].abs()) / radius_e56));
                                { let old = <u32>::load(m.proximal, 1 * ((v_e27)[_e58 as usize] as usize)); let new = old.wrapping_add(_e71); Stored::store(new, m.proximal, 1 * ((v_e27)[_e58 as usize] as usize)); old };
                            }
                        }
                        let _e73 = k_v1;
                        k_v1 = _e73.wrapping_add(1u32);
                    }
                }
                let _e77 = r_v0;
                let _e79 = (separation_e19).normal;
                let _e82 = ((separation_e19).distance - (separation_e19).wanted);
                let _e83 = (state_e22).multiplier;
                let _e86 = [0.0f32; 3];
                let _e88 = [0.0f32; 3];
                Stored::store(Row { vertices: v_e27, weights: weights_e35, normal: _e79, value: _e82, inverse_diagonal: 0.0f32, multiplier: _e83, candidate: c_e16, color: 0u32, slip: _e86, coefficient: 0.0f32, friction: _e88, bucket: 0u32 }, m.rows, 24 * (_e77 as usize));
            }
        }
        let _e93 = r_v0;
        r_v0 = _e93.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let vertices = bound.read(0);
    let candidates = bound.read(1);
    let separations = bound.read(2);
    let states = bound.read(3);
    let mut rows = bound.write(4);
    let mut proximal = bound.write(5);
    let mut control = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        vertices: &vertices,
        candidates: &candidates,
        separations: &separations,
        states: &states,
        rows: &mut rows,
        proximal: &mut proximal,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
