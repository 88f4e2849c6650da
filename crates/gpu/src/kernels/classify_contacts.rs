// Written from `shader/geometry/classify_contacts.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "classify_contacts",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/geometry/classify_contacts.wgsl"),
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
pub const VERTEX: u32 = 0u32;
pub const EDGE: u32 = 1u32;
pub const FACE: u32 = 2u32;
pub const OUTSIDE: u32 = 0u32;
pub const INSIDE: u32 = 1u32;
pub const FLAT: u32 = 2u32;
pub const ON_BORDER: f32 = 1e-6f32;
pub const CONE_TOLERANCE: f32 = 0.02f32;
pub const FLAT_TOLERANCE: f32 = 0.002f32;
pub const CLOSE: f32 = 1.001f32;
pub const SHARE: f32 = 0.9f32;
pub const LEAST_SHARE: f32 = 0.5f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub edges_first: u32,
    pub triangles_first: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::classify_contacts::*;
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

#[derive(Clone, Copy)]
pub struct Feature {
    pub kind: u32,
    pub index: u32,
}

impl Feature {
    const ZERO: Self = Self {
        kind: 0u32,
        index: 0u32,
    };
}

impl Stored for Feature {
    const WORDS: usize = 2;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            kind: <u32>::load(words, at + 0),
            index: <u32>::load(words, at + 1),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.kind.store(words, at + 0);
        self.index.store(words, at + 1);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    edges: &'a [u32],
    triangles: &'a [u32],
    adjacency: &'a [u32],
    candidates: &'a [u32],
    states: &'a [u32],
    separations: &'a mut [u32],
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

pub fn on_edge(edge_a0: u32, vertices_a1: [u32; 2], last_a2: f32) -> Feature {
    if ((1.0f32 - last_a2) <= 1e-6f32) {
        let _e8 = (vertices_a1)[1];
        return Feature { kind: 0u32, index: _e8 };
    }
    if (last_a2 <= 1e-6f32) {
        let _e13 = (vertices_a1)[0];
        return Feature { kind: 0u32, index: _e13 };
    }
    return Feature { kind: 1u32, index: edge_a0 };
}

pub fn on_triangle(m: &mut Memory<'_>, triangle_a0: u32, vertices_a1: [u32; 3], weights_a2: [f32; 3]) -> Feature {
    let inside_e5 = zip(weights_a2, [1e-6f32; 3], |x, y| (x > y));
    let _e8 = m.params.triangles_first;
    let first_edge_e11 = _e8.wrapping_add(3u32.wrapping_mul(triangle_a0));
    if all(inside_e5) {
        return Feature { kind: 2u32, index: triangle_a0 };
    }
    let mut local_v0: bool;
    if (inside_e5)[0] {
        local_v0 = (inside_e5)[1];
    } else {
        local_v0 = false;
    }
    let _e20 = local_v0;
    if _e20 {
        let _e24 = <u32>::load(m.adjacency, 1 * (first_edge_e11 as usize));
        return Feature { kind: 1u32, index: _e24 };
    }
    let mut local_v1: bool;
    if (inside_e5)[1] {
        local_v1 = (inside_e5)[2];
    } else {
        local_v1 = false;
    }
    let _e31 = local_v1;
    if _e31 {
        let _e37 = <u32>::load(m.adjacency, 1 * (first_edge_e11.wrapping_add(1u32) as usize));
        return Feature { kind: 1u32, index: _e37 };
    }
    let mut local_v2: bool;
    if (inside_e5)[0] {
        local_v2 = (inside_e5)[2];
    } else {
        local_v2 = false;
    }
    let _e44 = local_v2;
    if _e44 {
        let _e50 = <u32>::load(m.adjacency, 1 * (first_edge_e11.wrapping_add(2u32) as usize));
        return Feature { kind: 1u32, index: _e50 };
    }
    let _e59 = (if (inside_e5)[0] { (vertices_a1)[0] } else { (if (inside_e5)[1] { (vertices_a1)[1] } else { (vertices_a1)[2] }) });
    return Feature { kind: 0u32, index: _e59 };
}

pub fn place(m: &mut Memory<'_>, feature_a0: Feature, outward_a1: [f32; 3]) -> u32 {
    let mut along_v2: [f32; 3] = [0.0f32; 3];
    if ((feature_a0).kind == 2u32) {
        return 1u32;
    }
    let mut entry_v0: u32;
    entry_v0 = (feature_a0).index;
    let mut origin_v1: [i32; 3];
    if ((feature_a0).kind == 1u32) {
        let _e17 = entry_v0;
        let _e20 = m.params.edges_first;
        entry_v0 = _e17.wrapping_add(_e20);
        let edge_e25 = <[u32; 2]>::load(m.edges, 2 * ((feature_a0).index as usize));
        let _e29 = <[i32; 4]>::load(m.positions, 4 * ((edge_e25)[0] as usize));
        origin_v1 = swizzle(_e29, [0, 1, 2]);
        let _e34 = <[i32; 4]>::load(m.positions, 4 * ((edge_e25)[1] as usize));
        let _e36 = origin_v1;
        let whole_e38 = zip(swizzle(_e34, [0, 1, 2]), _e36, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        along_v2 = zip(whole_e38, [dot(whole_e38, whole_e38).sqrt().max(1.0f32); 3], |x, y| (x / y));
    } else {
        let _e48 = <[i32; 4]>::load(m.positions, 4 * ((feature_a0).index as usize));
        origin_v1 = swizzle(_e48, [0, 1, 2]);
    }
    let _e51 = entry_v0;
    let start_e53 = <u32>::load(m.adjacency, 1 * (_e51 as usize));
    let _e55 = entry_v0;
    let end_e59 = <u32>::load(m.adjacency, 1 * (_e55.wrapping_add(1u32) as usize));
    let mut local_v3: bool;
    if ((feature_a0).kind == 1u32) {
        local_v3 = (end_e59 > start_e53.wrapping_add(1u32));
    } else {
        local_v3 = false;
    }
    let _e69 = local_v3;
    let mut flat_v4: bool;
    flat_v4 = _e69;
    let mut k_v5: u32;
    k_v5 = start_e53;
    'l0: loop {
        'c0: {
            let _e72 = k_v5;
            if (_e72 < end_e59) {
            } else {
                break 'l0;
            }
            {
                let _e76 = k_v5;
                let _e78 = <u32>::load(m.adjacency, 1 * (_e76 as usize));
                let _e80 = <[i32; 4]>::load(m.positions, 4 * (_e78 as usize));
                let _e82 = origin_v1;
                let mut to_v6: [f32; 3];
                to_v6 = zip(swizzle(_e80, [0, 1, 2]), _e82, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                let _e86 = to_v6;
                let _e87 = along_v2;
                let _e88 = along_v2;
                let _e89 = to_v6;
                to_v6 = zip(_e86, _e87.map(|x| (x * dot(_e88, _e89))), |x, y| (x - y));
                let _e93 = to_v6;
                let _e94 = to_v6;
                let size_e96 = dot(_e93, _e94).sqrt();
                let _e97 = to_v6;
                let rise_e98 = dot(outward_a1, _e97);
                if (rise_e98 > (0.02f32 * size_e96)) {
                    return 0u32;
                }
                let _e103 = flat_v4;
                let mut local_v7: bool;
                if _e103 {
                    local_v7 = (rise_e98 >= ((-0.002f32) * size_e96));
                } else {
                    local_v7 = false;
                }
                let _e110 = local_v7;
                flat_v4 = _e110;
            }
        }
        let _e111 = k_v5;
        k_v5 = _e111.wrapping_add(1u32);
    }
    let _e116 = flat_v4;
    return (if _e116 { 2u32 } else { 1u32 });
}

pub fn is_contact(m: &mut Memory<'_>, pair_a0: Pair, candidate_a1: Candidate, separation_a2: Separation) -> bool {
    let v_e3 = (pair_a0).vertices;
    let weights_e4 = (separation_a2).weights;
    let _e6 = (v_e3)[0];
    let mut a_v0: Feature;
    a_v0 = Feature { kind: 0u32, index: _e6 };
    let _e10 = (v_e3)[1];
    let mut b_v1: Feature;
    b_v1 = Feature { kind: 0u32, index: _e10 };
    's0: { match (pair_a0).kind {
    1u32 => {
        let _e15 = (v_e3)[1];
        let _e16 = (v_e3)[2];
        let _e19 = on_edge((candidate_a1).b, [_e15, _e16], (weights_e4)[0]);
        b_v1 = _e19;
    }
    2u32 => {
        let _e24 = ((1.0f32 - (weights_e4)[0]) - (weights_e4)[1]);
        let all_weights_e25 = [_e24, (weights_e4)[0], (weights_e4)[1]];
        let _e27 = (v_e3)[1];
        let _e28 = (v_e3)[2];
        let _e29 = (v_e3)[3];
        let _e31 = on_triangle(m, (candidate_a1).b, [_e27, _e28, _e29], all_weights_e25);
        b_v1 = _e31;
    }
    3u32 => {
        let _e35 = (v_e3)[0];
        let _e36 = (v_e3)[1];
        let _e39 = on_edge(((candidate_a1).kind_and_a & 536870911u32), [_e35, _e36], (weights_e4)[0]);
        a_v0 = _e39;
        let _e41 = (v_e3)[2];
        let _e42 = (v_e3)[3];
        let _e45 = on_edge((candidate_a1).b, [_e41, _e42], (weights_e4)[1]);
        b_v1 = _e45;
    }
    4u32 => {
        b_v1 = Feature { kind: 2u32, index: 0u32 };
    }
    _ => {
    }
    } }
    let _e50 = a_v0.kind;
    let mut local_v2: bool;
    if (_e50 == 0u32) {
        let _e56 = b_v1.kind;
        local_v2 = (_e56 == 2u32);
    } else {
        local_v2 = false;
    }
    let _e60 = local_v2;
    if _e60 {
        return true;
    }
    let _e62 = a_v0;
    let first_e65 = place(m, _e62, (separation_a2).normal.map(|x| (-x)));
    if (first_e65 == 0u32) {
        return false;
    }
    let _e69 = b_v1;
    let second_e71 = place(m, _e69, (separation_a2).normal);
    let mut local_v3: bool;
    if (first_e65 == 2u32) {
        local_v3 = (second_e71 == 2u32);
    } else {
        local_v3 = false;
    }
    let _e79 = local_v3;
    let mut local_v4: bool;
    if _e79 {
        let _e83 = a_v0.kind;
        local_v4 = (_e83 == 1u32);
    } else {
        local_v4 = false;
    }
    let _e87 = local_v4;
    let mut local_v5: bool;
    if _e87 {
        let _e91 = b_v1.kind;
        local_v5 = (_e91 == 1u32);
    } else {
        local_v5 = false;
    }
    let both_flat_e95 = local_v5;
    let mut local_v6: bool;
    if (second_e71 != 0u32) {
        local_v6 = (!both_flat_e95);
    } else {
        local_v6 = false;
    }
    let _e102 = local_v6;
    return _e102;
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
                let _e13 = c_v0;
                let separation_e15 = <Separation>::load(m.separations, 12 * (_e13 as usize));
                let _e17 = c_v0;
                let state_e19 = <PairState>::load(m.states, 8 * (_e17 as usize));
                let mut local_v1: bool;
                if (!((separation_e15).distance > (state_e19).range)) {
                    let _e27 = c_v0;
                    let _e29 = <Candidate>::load(m.candidates, 2 * (_e27 as usize));
                    let _e30 = pair_of(m, _e29);
                    let _e32 = c_v0;
                    let _e34 = <Candidate>::load(m.candidates, 2 * (_e32 as usize));
                    let _e35 = is_contact(m, _e30, _e34, separation_e15);
                    local_v1 = _e35;
                } else {
                    local_v1 = true;
                }
                let _e37 = local_v1;
                if _e37 {
                    break 'c0;
                }
                let mut wanted_v2: f32;
                wanted_v2 = 0.0f32;
                let mut local_v3: bool;
                if (!((separation_e15).distance < (1.001f32 * (state_e19).desired))) {
                    local_v3 = ((state_e19).multiplier > 0.0f32);
                } else {
                    local_v3 = true;
                }
                let _e52 = local_v3;
                if _e52 {
                    wanted_v2 = (0.9f32 * (separation_e15).distance).max((0.5f32 * (state_e19).desired)).min((state_e19).desired);
                }
                let _e62 = c_v0;
                let _e65 = wanted_v2;
                Stored::store(_e65, m.separations, 12 * (_e62 as usize) + 8);
            }
        }
        let _e66 = c_v0;
        c_v0 = _e66.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let edges = bound.read(1);
    let triangles = bound.read(2);
    let adjacency = bound.read(3);
    let candidates = bound.read(4);
    let states = bound.read(5);
    let mut separations = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        edges: &edges,
        triangles: &triangles,
        adjacency: &adjacency,
        candidates: &candidates,
        states: &states,
        separations: &mut separations,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
