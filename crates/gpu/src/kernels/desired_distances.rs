// Written from `shader/geometry/desired_distances.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "desired_distances",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/closest.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/geometry/desired_distances.wgsl"),
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
pub const MIN_SEPARATION_SHARE: f32 = 0.1f32;
pub const MIN_SEPARATION_MARGIN: f32 = 1.5f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub after_search: u32,
    pub min_separation: f32,
    pub growth: f32,
    pub range: f32,
    pub first_half_space: u32,
    pub known: f32,
    pub guarded: f32,
    pub guarded_floor: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::desired_distances::*;
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
pub struct Closest {
    pub offset: [f32; 3],
    pub weights: [f32; 3],
}

impl Closest {
    const ZERO: Self = Self {
        offset: [0.0f32; 3],
        weights: [0.0f32; 3],
    };
}

impl Stored for Closest {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            offset: <[f32; 3]>::load(words, at + 0),
            weights: <[f32; 3]>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.offset.store(words, at + 0);
        self.weights.store(words, at + 4);
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
    rest: &'a [u32],
    edges: &'a [u32],
    triangles: &'a [u32],
    vertices: &'a [u32],
    candidates: &'a [u32],
    separations: &'a mut [u32],
    states: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn on_edge(a_a0: [f32; 3], b_a1: [f32; 3]) -> f32 {
    let along_e2 = zip(b_a1, a_a0, |x, y| (x - y));
    let squared_e3 = dot(along_e2, along_e2);
    if (squared_e3 <= 0.0f32) {
        return 0.0f32;
    }
    return ((-dot(a_a0, along_e2)) / squared_e3).max(0.0f32).min(1.0f32);
}

pub fn closest_vertex_edge(a_a0: [f32; 3], b_a1: [f32; 3]) -> Closest {
    let t_e2 = on_edge(a_a0, b_a1);
    let _e6 = zip(a_a0, zip(b_a1, a_a0, |x, y| (x - y)).map(|x| (x * t_e2)), |x, y| (x + y)).map(|x| (-x));
    let _e8 = (1.0f32 - t_e2);
    let _e10 = [_e8, t_e2, 0.0f32];
    return Closest { offset: _e6, weights: _e10 };
}

pub fn closest_vertex_triangle(a_a0: [f32; 3], b_a1: [f32; 3], c_a2: [f32; 3]) -> Closest {
    let ab_e3 = zip(b_a1, a_a0, |x, y| (x - y));
    let ac_e4 = zip(c_a2, a_a0, |x, y| (x - y));
    let d1_e6 = (-dot(ab_e3, a_a0));
    let d2_e8 = (-dot(ac_e4, a_a0));
    let d3_e10 = (-dot(ab_e3, b_a1));
    let d4_e12 = (-dot(ac_e4, b_a1));
    let d5_e14 = (-dot(ab_e3, c_a2));
    let d6_e16 = (-dot(ac_e4, c_a2));
    let va_e19 = ((d3_e10 * d6_e16) - (d5_e14 * d4_e12));
    let vb_e22 = ((d5_e14 * d2_e8) - (d1_e6 * d6_e16));
    let vc_e25 = ((d1_e6 * d4_e12) - (d3_e10 * d2_e8));
    let mut local_v1: bool;
    if (d1_e6 <= 0.0f32) {
        local_v1 = (d2_e8 <= 0.0f32);
    } else {
        local_v1 = false;
    }
    let _e36 = local_v1;
    let mut w_v0: [f32; 3];
    if _e36 {
        w_v0 = [1.0f32, 0.0f32, 0.0f32];
    } else {
        let mut local_v2: bool;
        if (d3_e10 >= 0.0f32) {
            local_v2 = (d4_e12 <= d3_e10);
        } else {
            local_v2 = false;
        }
        let _e47 = local_v2;
        if _e47 {
            w_v0 = [0.0f32, 1.0f32, 0.0f32];
        } else {
            let mut local_v3: bool;
            if (d6_e16 >= 0.0f32) {
                local_v3 = (d5_e14 <= d6_e16);
            } else {
                local_v3 = false;
            }
            let _e58 = local_v3;
            if _e58 {
                w_v0 = [0.0f32, 0.0f32, 1.0f32];
            } else {
                let mut local_v4: bool;
                if (vc_e25 <= 0.0f32) {
                    local_v4 = (d1_e6 >= 0.0f32);
                } else {
                    local_v4 = false;
                }
                let _e70 = local_v4;
                let mut local_v5: bool;
                if _e70 {
                    local_v5 = (d3_e10 <= 0.0f32);
                } else {
                    local_v5 = false;
                }
                let _e76 = local_v5;
                if _e76 {
                    let t_e77 = on_edge(a_a0, b_a1);
                    let _e79 = (1.0f32 - t_e77);
                    w_v0 = [_e79, t_e77, 0.0f32];
                } else {
                    let mut local_v6: bool;
                    if (vb_e22 <= 0.0f32) {
                        local_v6 = (d2_e8 >= 0.0f32);
                    } else {
                        local_v6 = false;
                    }
                    let _e89 = local_v6;
                    let mut local_v7: bool;
                    if _e89 {
                        local_v7 = (d6_e16 <= 0.0f32);
                    } else {
                        local_v7 = false;
                    }
                    let _e95 = local_v7;
                    if _e95 {
                        let t_e96 = on_edge(a_a0, c_a2);
                        let _e98 = (1.0f32 - t_e96);
                        w_v0 = [_e98, 0.0f32, t_e96];
                    } else {
                        let mut local_v8: bool;
                        if (va_e19 <= 0.0f32) {
                            local_v8 = ((d4_e12 - d3_e10) >= 0.0f32);
                        } else {
                            local_v8 = false;
                        }
                        let _e109 = local_v8;
                        let mut local_v9: bool;
                        if _e109 {
                            local_v9 = ((d5_e14 - d6_e16) >= 0.0f32);
                        } else {
                            local_v9 = false;
                        }
                        let _e116 = local_v9;
                        if _e116 {
                            let t_e117 = on_edge(b_a1, c_a2);
                            let _e119 = (1.0f32 - t_e117);
                            w_v0 = [0.0f32, _e119, t_e117];
                        } else {
                            let sum_e123 = ((va_e19 + vb_e22) + vc_e25);
                            w_v0 = [1.0f32, 0.0f32, 0.0f32];
                            if (sum_e123 > 0.0f32) {
                                let v_e130 = (vb_e22 / sum_e123);
                                let u_e131 = (vc_e25 / sum_e123);
                                let _e134 = ((1.0f32 - v_e130) - u_e131);
                                w_v0 = [_e134, v_e130, u_e131];
                            }
                        }
                    }
                }
            }
        }
    }
    let _e137 = w_v0[0];
    let _e140 = w_v0[1];
    let _e144 = w_v0[2];
    let _e147 = zip(zip(a_a0.map(|x| (x * _e137)), b_a1.map(|x| (x * _e140)), |x, y| (x + y)), c_a2.map(|x| (x * _e144)), |x, y| (x + y)).map(|x| (-x));
    let _e148 = w_v0;
    return Closest { offset: _e147, weights: _e148 };
}

pub fn closer(a_a0: Closest, b_a1: Closest) -> Closest {
    if (dot((b_a1).offset, (b_a1).offset) < dot((a_a0).offset, (a_a0).offset)) {
        return b_a1;
    }
    return a_a0;
}

pub fn closest_edge_edge(p_a0: [f32; 3], q0_a1: [f32; 3], q1_a2: [f32; 3]) -> Closest {
    let along_e3 = zip(q1_a2, q0_a1, |x, y| (x - y));
    let a_e4 = dot(p_a0, p_a0);
    let e_e5 = dot(along_e3, along_e3);
    let b_e6 = dot(p_a0, along_e3);
    let c_e8 = (-dot(p_a0, q0_a1));
    let f_e10 = (-dot(along_e3, q0_a1));
    let determinant_e13 = ((a_e4 * e_e5) - (b_e6 * b_e6));
    let mut best_v0: Closest;
    if (determinant_e13 > ((1e-5f32 * a_e4) * e_e5)) {
        let s_e25 = (((b_e6 * f_e10) - (c_e8 * e_e5)) / determinant_e13).max(0.0f32).min(1.0f32);
        let t_e31 = (((b_e6 * s_e25) + f_e10) / e_e5).max(0.0f32).min(1.0f32);
        let back_e37 = (((b_e6 * t_e31) - c_e8) / a_e4).max(0.0f32).min(1.0f32);
        let _e41 = zip(p_a0.map(|x| (x * back_e37)), zip(q0_a1, along_e3.map(|x| (x * t_e31)), |x, y| (x + y)), |x, y| (x - y));
        let _e43 = (1.0f32 - t_e31);
        let _e44 = [back_e37, _e43, t_e31];
        best_v0 = Closest { offset: _e41, weights: _e44 };
    } else {
        let s_e46 = on_edge(q0_a1, q1_a2);
        let _e49 = zip(q0_a1, along_e3.map(|x| (x * s_e46)), |x, y| (x + y)).map(|x| (-x));
        let _e51 = (1.0f32 - s_e46);
        let _e53 = [0.0f32, _e51, s_e46];
        best_v0 = Closest { offset: _e49, weights: _e53 };
        let t_e57 = on_edge(zip(q0_a1, p_a0, |x, y| (x - y)), zip(q1_a2, p_a0, |x, y| (x - y)));
        let _e58 = best_v0;
        let _e61 = zip(p_a0, zip(q0_a1, along_e3.map(|x| (x * t_e57)), |x, y| (x + y)), |x, y| (x - y));
        let _e63 = (1.0f32 - t_e57);
        let _e65 = [1.0f32, _e63, t_e57];
        let _e67 = closer(_e58, Closest { offset: _e61, weights: _e65 });
        best_v0 = _e67;
        let u_e70 = on_edge(q0_a1.map(|x| (-x)), zip(p_a0, q0_a1, |x, y| (x - y)));
        let _e71 = best_v0;
        let _e73 = zip(p_a0.map(|x| (x * u_e70)), q0_a1, |x, y| (x - y));
        let _e76 = [u_e70, 1.0f32, 0.0f32];
        let _e78 = closer(_e71, Closest { offset: _e73, weights: _e76 });
        best_v0 = _e78;
        let v_e81 = on_edge(q1_a2.map(|x| (-x)), zip(p_a0, q1_a2, |x, y| (x - y)));
        let _e82 = best_v0;
        let _e84 = zip(p_a0.map(|x| (x * v_e81)), q1_a2, |x, y| (x - y));
        let _e87 = [v_e81, 0.0f32, 1.0f32];
        let _e89 = closer(_e82, Closest { offset: _e84, weights: _e87 });
        best_v0 = _e89;
    }
    let _e90 = best_v0;
    return _e90;
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

pub fn rest_distance(m: &mut Memory<'_>, pair_a0: Pair) -> f32 {
    let _e5 = <[i32; 4]>::load(m.rest, 4 * (((pair_a0).vertices)[0] as usize));
    let p_e6 = swizzle(_e5, [0, 1, 2]);
    let _e11 = <[i32; 4]>::load(m.rest, 4 * (((pair_a0).vertices)[1] as usize));
    let a_e14 = zip(swizzle(_e11, [0, 1, 2]), p_e6, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
    let mut offset_v0: [f32; 3];
    offset_v0 = a_e14;
    if ((pair_a0).kind == 1u32) {
        let _e23 = <[i32; 4]>::load(m.rest, 4 * (((pair_a0).vertices)[2] as usize));
        let _e27 = closest_vertex_edge(a_e14, zip(swizzle(_e23, [0, 1, 2]), p_e6, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)));
        offset_v0 = (_e27).offset;
    } else {
        if ((pair_a0).kind != 0u32) {
            let _e36 = <[i32; 4]>::load(m.rest, 4 * (((pair_a0).vertices)[2] as usize));
            let b_e39 = zip(swizzle(_e36, [0, 1, 2]), p_e6, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
            let _e44 = <[i32; 4]>::load(m.rest, 4 * (((pair_a0).vertices)[3] as usize));
            let c_e47 = zip(swizzle(_e44, [0, 1, 2]), p_e6, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
            if ((pair_a0).kind == 3u32) {
                let _e51 = closest_edge_edge(a_e14, b_e39, c_e47);
                offset_v0 = (_e51).offset;
            } else {
                let _e53 = closest_vertex_triangle(a_e14, b_e39, c_e47);
                offset_v0 = (_e53).offset;
            }
        }
    }
    let _e55 = offset_v0;
    let _e56 = offset_v0;
    return dot(_e55, _e56).sqrt();
}

pub fn flags_of(m: &mut Memory<'_>, pair_a0: Pair) -> u32 {
    let v_e1 = (pair_a0).vertices;
    let _e6 = <u32>::load(m.vertices, 12 * ((v_e1)[0] as usize) + 3);
    let _e11 = <u32>::load(m.vertices, 12 * ((v_e1)[1] as usize) + 3);
    let _e17 = <u32>::load(m.vertices, 12 * ((v_e1)[2] as usize) + 3);
    let _e23 = <u32>::load(m.vertices, 12 * ((v_e1)[3] as usize) + 3);
    return (((_e6 | _e11) | _e17) | _e23);
}

pub fn first_state(m: &mut Memory<'_>, candidate_a0: Candidate, separation_a1: Separation) -> PairState {
    let mut thickness_v2: f32 = (-1.0f32);
    let pair_e2 = pair_of(m, candidate_a0);
    let a_e7 = <Vertex>::load(m.vertices, 12 * (((pair_e2).vertices)[0] as usize));
    let mut delta_v0: f32;
    delta_v0 = (a_e7).half_space_delta;
    let _e12 = m.params.range;
    let _e13 = delta_v0;
    let mut range_v1: f32;
    range_v1 = (_e12 * _e13);
    if ((pair_e2).kind == 4u32) {
        let _e24 = m.params.first_half_space;
        let b_e28 = <Vertex>::load(m.vertices, 12 * (_e24.wrapping_add((candidate_a0).b) as usize));
        if ((b_e28).thickness >= 0.0f32) {
            let _e32 = delta_v0;
            delta_v0 = _e32.max((0.5f32 * ((a_e7).delta + (1.5f32 * (b_e28).thickness))));
            let _e43 = m.params.range;
            let _e44 = delta_v0;
            range_v1 = (_e43 * _e44);
        }
        if ((a_e7).thickness.max((b_e28).thickness) >= 0.0f32) {
            let _e53 = m.params.min_separation;
            let of_a_e58 = (if ((a_e7).thickness >= 0.0f32) { (a_e7).thickness } else { _e53 });
            thickness_v2 = (0.5f32 * (of_a_e58 + (b_e28).thickness.max(0.0f32)));
        }
    } else {
        let b_e70 = <Vertex>::load(m.vertices, 12 * (((pair_e2).vertices)[(pair_e2).side_a as usize] as usize));
        delta_v0 = (0.5f32 * ((a_e7).delta + (b_e70).delta));
        if ((a_e7).thickness.max((b_e70).thickness) >= 0.0f32) {
            let _e83 = m.params.min_separation;
            let of_a_e88 = (if ((a_e7).thickness >= 0.0f32) { (a_e7).thickness } else { _e83 });
            let _e91 = m.params.min_separation;
            let of_b_e96 = (if ((b_e70).thickness >= 0.0f32) { (b_e70).thickness } else { _e91 });
            thickness_v2 = (0.5f32 * (of_a_e88 + of_b_e96));
        }
        let _e102 = m.params.range;
        let _e103 = delta_v0;
        range_v1 = (_e102 * _e103);
        let _e110 = <i32>::load(m.rest, 4 * (((pair_e2).vertices)[0] as usize) + 3);
        let _e117 = <i32>::load(m.rest, 4 * (((pair_e2).vertices)[(pair_e2).side_a as usize] as usize) + 3);
        if (_e110 == _e117) {
            let _e119 = delta_v0;
            let _e120 = rest_distance(m, pair_e2);
            delta_v0 = _e119.min((0.5f32 * _e120));
        }
    }
    let distance_e126 = (separation_a1).distance.max(0.0f32);
    let _e127 = delta_v0;
    let _e130 = m.params.growth;
    let mut desired_v3: f32;
    desired_v3 = _e127.min((distance_e126 + _e130));
    let _e136 = m.params.min_separation;
    let _e138 = desired_v3;
    let mut least_v4: f32;
    least_v4 = _e136.min((0.1f32 * _e138));
    let _e142 = thickness_v2;
    if (_e142 >= 0.0f32) {
        let _e145 = thickness_v2;
        let _e146 = delta_v0;
        least_v4 = _e145.min((_e146 / 1.5f32)).min((separation_a1).width.max(0.0f32));
    }
    let _e154 = flags_of(m, pair_e2);
    let known_e156 = (_e154 & 8u32);
    let mut local_v5: bool;
    if (known_e156 != 0u32) {
        let _e163 = m.params.known;
        let _e164 = delta_v0;
        local_v5 = (distance_e126 < (_e163 * _e164));
    } else {
        local_v5 = false;
    }
    let _e168 = local_v5;
    if _e168 {
        let _e169 = least_v4;
        let _e172 = m.params.guarded_floor;
        let _e173 = delta_v0;
        let _e174 = least_v4;
        let lowest_e177 = (_e169 + (_e172 * (_e173 - _e174)));
        let _e178 = desired_v3;
        let _e181 = m.params.guarded;
        desired_v3 = _e178.min((_e181 * distance_e126).max(lowest_e177));
    }
    let _e186 = [0.0f32; 3];
    let _e187 = desired_v3;
    let _e188 = least_v4;
    let _e189 = range_v1;
    return PairState { friction: _e186, multiplier: 0.0f32, desired: _e187, min_separation: _e188, range: _e189, is_far: 0u32 };
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = m.params.after_search;
    let mut local_v0: bool;
    if (_e3 != 0u32) {
        let _e10 = <u32>::load(m.control, 0);
        local_v0 = (_e10 == 0u32);
    } else {
        local_v0 = false;
    }
    let _e14 = local_v0;
    if _e14 {
        return;
    }
    let _e17 = <u32>::load(m.control, 13);
    let _e20 = m.params.capacity;
    let count_e21 = _e17.min(_e20);
    let mut c_v1: u32;
    c_v1 = ([128 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e24 = c_v1;
            if (_e24 < count_e21) {
            } else {
                break 'l0;
            }
            {
                let _e27 = c_v1;
                let _e30 = <f32>::load(m.states, 8 * (_e27 as usize) + 4);
                let is_new_e32 = (_e30 < 0.0f32);
                let mut local_v2: bool;
                if (!is_new_e32) {
                    let _e37 = c_v1;
                    let _e40 = <u32>::load(m.states, 8 * (_e37 as usize) + 7);
                    let mut local_v3: bool;
                    if (_e40 != 0u32) {
                        let _e46 = c_v1;
                        let _e49 = <f32>::load(m.separations, 12 * (_e46 as usize) + 6);
                        let _e51 = c_v1;
                        let _e54 = <f32>::load(m.states, 8 * (_e51 as usize) + 6);
                        local_v3 = (_e49 <= _e54);
                    } else {
                        local_v3 = false;
                    }
                    let _e57 = local_v3;
                    local_v2 = _e57;
                } else {
                    local_v2 = true;
                }
                let _e59 = local_v2;
                if _e59 {
                    let _e61 = c_v1;
                    let _e63 = <Candidate>::load(m.candidates, 2 * (_e61 as usize));
                    let _e65 = c_v1;
                    let _e67 = <Separation>::load(m.separations, 12 * (_e65 as usize));
                    let first_e68 = first_state(m, _e63, _e67);
                    let _e70 = c_v1;
                    Stored::store((first_e68).desired, m.states, 8 * (_e70 as usize) + 4);
                    let _e75 = c_v1;
                    Stored::store((first_e68).min_separation, m.states, 8 * (_e75 as usize) + 5);
                    let _e80 = c_v1;
                    Stored::store((first_e68).range, m.states, 8 * (_e80 as usize) + 6);
                }
                let _e85 = c_v1;
                let _e89 = c_v1;
                let _e92 = <f32>::load(m.separations, 12 * (_e89 as usize) + 6);
                let _e94 = c_v1;
                let _e97 = <f32>::load(m.states, 8 * (_e94 as usize) + 6);
                Stored::store(u32::from((_e92 > _e97)), m.states, 8 * (_e85 as usize) + 7);
                let _e101 = c_v1;
                let _e105 = c_v1;
                let _e108 = <f32>::load(m.states, 8 * (_e105 as usize) + 5);
                Stored::store(_e108, m.separations, 12 * (_e101 as usize) + 7);
                let _e110 = c_v1;
                let _e114 = c_v1;
                let _e117 = <f32>::load(m.states, 8 * (_e114 as usize) + 4);
                Stored::store(_e117, m.separations, 12 * (_e110 as usize) + 8);
            }
        }
        let _e118 = c_v1;
        c_v1 = _e118.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let rest = bound.read(0);
    let edges = bound.read(1);
    let triangles = bound.read(2);
    let vertices = bound.read(3);
    let candidates = bound.read(4);
    let mut separations = bound.write(5);
    let mut states = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        rest: &rest,
        edges: &edges,
        triangles: &triangles,
        vertices: &vertices,
        candidates: &candidates,
        separations: &mut separations,
        states: &mut states,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
