// Written from `shader/rows/select_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "select_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/rows/select_rows.wgsl"),
    ],
    workgroup: 128,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
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
    pub threshold: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::select_rows::*;
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
    displacements: &'a [u32],
    edges: &'a [u32],
    triangles: &'a [u32],
    candidates: &'a [u32],
    separations: &'a [u32],
    states: &'a mut [u32],
    starts: &'a mut [u32],
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

pub fn pair_of(m: &mut Memory<'_>, candidate_a0: Candidate) -> Pair {
    let kind_e3 = (candidate_a0).kind_and_a.wrapping_shr(29u32);
    let a_e6 = ((candidate_a0).kind_and_a & 536870911u32);
    let b_e7 = (candidate_a0).b;
    let mut vertices_v0: [u32; 4];
    vertices_v0 = [a_e6; 4];
    's0: { match kind_e3 {
    0u32 => {
        vertices_v0[1] = b_e7;
    }
    1u32 => {
        let _e13 = <[u32; 2]>::load(m.edges, 2 * (b_e7 as usize));
        vertices_v0 = [a_e6, (_e13)[0], (_e13)[1], a_e6];
    }
    2u32 => {
        let _e17 = <[u32; 4]>::load(m.triangles, 4 * (b_e7 as usize));
        let _e18 = swizzle(_e17, [0, 1, 2]);
        vertices_v0 = [a_e6, (_e18)[0], (_e18)[1], (_e18)[2]];
    }
    3u32 => {
        let _e22 = <[u32; 2]>::load(m.edges, 2 * (a_e6 as usize));
        let _e25 = <[u32; 2]>::load(m.edges, 2 * (b_e7 as usize));
        vertices_v0 = [(_e22)[0], (_e22)[1], (_e25)[0], (_e25)[1]];
    }
    _ => {
    }
    } }
    let _e27 = vertices_v0;
    let _e28 = pair_with(kind_e3, _e27);
    return _e28;
}

pub fn is_selected(m: &mut Memory<'_>, c_a0: u32) -> bool {
    let mut k_v2: u32 = 0u32;
    let state_e3 = <PairState>::load(m.states, 8 * (c_a0 as usize));
    let separation_e6 = <Separation>::load(m.separations, 12 * (c_a0 as usize));
    let mut local_v0: bool;
    if (!((separation_e6).distance > (state_e3).range)) {
        local_v0 = ((separation_e6).wanted == 0.0f32);
    } else {
        local_v0 = true;
    }
    let _e17 = local_v0;
    if _e17 {
        return false;
    }
    if ((state_e3).multiplier > 0.0f32) {
        return true;
    }
    let _e25 = <Candidate>::load(m.candidates, 2 * (c_a0 as usize));
    let pair_e26 = pair_of(m, _e25);
    let weights_e27 = signed_weights(pair_e26, separation_e6);
    let mut gap_v1: f32;
    gap_v1 = (separation_e6).distance;
    'l0: loop {
        'c0: {
            let _e32 = k_v2;
            if (_e32 < (pair_e26).count) {
            } else {
                break 'l0;
            }
            {
                let _e35 = gap_v1;
                let _e36 = k_v2;
                let _e41 = k_v2;
                let _e44 = <[f32; 4]>::load(m.displacements, 4 * (((pair_e26).vertices)[_e41 as usize] as usize));
                gap_v1 = (_e35 + ((weights_e27)[_e36 as usize] * dot((separation_e6).normal, swizzle(_e44, [0, 1, 2]))));
            }
        }
        let _e49 = k_v2;
        k_v2 = _e49.wrapping_add(1u32);
    }
    let _e52 = gap_v1;
    let _e55 = m.params.threshold;
    return (_e52 < (_e55 * (separation_e6).wanted));
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 13);
    let _e6 = m.params.capacity;
    let count_e7 = _e3.min(_e6);
    let mut c_v0: u32;
    c_v0 = ([128 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = c_v0;
            if (_e10 < count_e7) {
            } else {
                break 'l0;
            }
            {
                let _e12 = c_v0;
                let selected_e13 = is_selected(m, _e12);
                if (!selected_e13) {
                    let _e16 = c_v0;
                    Stored::store(0.0f32, m.states, 8 * (_e16 as usize) + 3);
                    let _e21 = c_v0;
                    Stored::store([0.0f32; 3], m.states, 8 * (_e21 as usize));
                }
                let _e27 = c_v0;
                Stored::store(u32::from(selected_e13), m.starts, 1 * (_e27 as usize));
            }
        }
        let _e30 = c_v0;
        c_v0 = _e30.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let displacements = bound.read(0);
    let edges = bound.read(1);
    let triangles = bound.read(2);
    let candidates = bound.read(3);
    let separations = bound.read(4);
    let mut states = bound.write(5);
    let mut starts = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        displacements: &displacements,
        edges: &edges,
        triangles: &triangles,
        candidates: &candidates,
        separations: &separations,
        states: &mut states,
        starts: &mut starts,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
