// Written from `shader/geometry/separate.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "separate",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/closest.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/geometry/separate.wgsl"),
    ],
    workgroup: 128,
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
pub const WIDTH_ROUNDING: f32 = 3.8146973e-6f32;
pub const MIN_WIDTH_RATIO: f32 = 0.9f32;
pub const POINT_ROUNDING: f32 = 1.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub after_search: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::separate::*;
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
pub struct Plane {
    pub normal: [f32; 3],
    pub rounding: f32,
    pub point: [i32; 3],
    pub padding: u32,
}

impl Plane {
    const ZERO: Self = Self {
        normal: [0.0f32; 3],
        rounding: 0.0f32,
        point: [0i32; 3],
        padding: 0u32,
    };
}

impl Stored for Plane {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            normal: <[f32; 3]>::load(words, at + 0),
            rounding: <f32>::load(words, at + 3),
            point: <[i32; 3]>::load(words, at + 4),
            padding: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.normal.store(words, at + 0);
        self.rounding.store(words, at + 3);
        self.point.store(words, at + 4);
        self.padding.store(words, at + 7);
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

#[derive(Clone, Copy)]
pub struct Differences {
    pub d: [[f32; 3]; 4],
    pub count: u32,
    pub slack: f32,
}

impl Differences {
    const ZERO: Self = Self {
        d: [[0.0f32; 3]; 4],
        count: 0u32,
        slack: 0.0f32,
    };
}

impl Stored for Differences {
    const WORDS: usize = 20;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            d: <[[f32; 3]; 4]>::load(words, at + 0),
            count: <u32>::load(words, at + 16),
            slack: <f32>::load(words, at + 17),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.d.store(words, at + 0);
        self.count.store(words, at + 16);
        self.slack.store(words, at + 17);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    edges: &'a [u32],
    triangles: &'a [u32],
    planes: &'a [u32],
    candidates: &'a [u32],
    separations: &'a mut [u32],
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

pub fn size(v_a0: [f32; 3]) -> f32 {
    return (v_a0)[0].abs().max((v_a0)[1].abs()).max((v_a0)[2].abs());
}

pub fn width_along(n_a0: [f32; 3], differences_a1: Differences) -> f32 {
    let mut k_v1: u32 = 1u32;
    let mut width_v0: f32;
    width_v0 = dot(n_a0, ((differences_a1).d)[0]);
    'l0: loop {
        'c0: {
            let _e8 = k_v1;
            if (_e8 < (differences_a1).count) {
            } else {
                break 'l0;
            }
            {
                let _e11 = width_v0;
                let _e13 = k_v1;
                width_v0 = _e11.min(dot(n_a0, ((differences_a1).d)[_e13 as usize]));
            }
        }
        let _e17 = k_v1;
        k_v1 = _e17.wrapping_add(1u32);
    }
    let _e20 = width_v0;
    return (_e20 - (differences_a1).slack);
}

pub fn sine_between(a_a0: [f32; 3], b_a1: [f32; 3]) -> f32 {
    let product_e14 = cross(zip(a_a0, [dot(a_a0, a_a0).sqrt().max(1.0f32); 3], |x, y| (x / y)), zip(b_a1, [dot(b_a1, b_a1).sqrt().max(1.0f32); 3], |x, y| (x / y)));
    return dot(product_e14, product_e14).sqrt();
}

pub fn separate_plane(m: &mut Memory<'_>, v_a0: u32, p_a1: u32) -> Separation {
    let plane_e4 = <Plane>::load(m.planes, 8 * (p_a1 as usize));
    let _e7 = <[i32; 4]>::load(m.positions, 4 * (v_a0 as usize));
    let offset_e11 = zip(swizzle(_e7, [0, 1, 2]), (plane_e4).point, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
    let height_e13 = dot((plane_e4).normal, offset_e11);
    let _e14 = (plane_e4).normal;
    let _e16 = size(offset_e11);
    let _e20 = ((height_e13 - ((plane_e4).rounding * _e16)) - 1.0f32);
    let _e22 = [0.0f32; 2];
    return Separation { normal: _e14, width: _e20, weights: _e22, distance: height_e13, min_separation: 0.0f32, wanted: 0.0f32, sine: 0.0f32, padding_0: 0u32, padding_1: 0u32 };
}

pub fn separate_pair(m: &mut Memory<'_>, candidate_a0: Candidate) -> Separation {
    let mut differences_v0: Differences = Differences::ZERO;
    let mut other_v2: [f32; 3] = [0.0f32; 3];
    let mut sine_v3: f32 = 0.0f32;
    let mut largest_v4: f32 = 0.0f32;
    let mut k_v5: u32 = 0u32;
    let pair_e1 = pair_of(m, candidate_a0);
    if ((pair_e1).kind == 4u32) {
        let _e8 = separate_plane(m, ((pair_e1).vertices)[0], (candidate_a0).b);
        return _e8;
    }
    let _e20 = <[i32; 4]>::load(m.positions, 4 * (((pair_e1).vertices)[0] as usize));
    let p_e21 = swizzle(_e20, [0, 1, 2]);
    let _e26 = <[i32; 4]>::load(m.positions, 4 * (((pair_e1).vertices)[1] as usize));
    let q_e27 = swizzle(_e26, [0, 1, 2]);
    let mut closest_v1: Closest;
    if ((pair_e1).kind == 3u32) {
        let _e35 = <[i32; 4]>::load(m.positions, 4 * (((pair_e1).vertices)[2] as usize));
        let b0_e36 = swizzle(_e35, [0, 1, 2]);
        let _e41 = <[i32; 4]>::load(m.positions, 4 * (((pair_e1).vertices)[3] as usize));
        let b1_e42 = swizzle(_e41, [0, 1, 2]);
        differences_v0.d[0] = zip(p_e21, b0_e36, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        differences_v0.d[1] = zip(p_e21, b1_e42, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        differences_v0.d[2] = zip(q_e27, b0_e36, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        differences_v0.d[3] = zip(q_e27, b1_e42, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        differences_v0.count = 4u32;
        let along_e62 = zip(q_e27, p_e21, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        let _e65 = differences_v0.d[0];
        let _e69 = differences_v0.d[1];
        let _e71 = closest_edge_edge(along_e62, _e65.map(|x| (-x)), _e69.map(|x| (-x)));
        closest_v1 = _e71;
        let across_e73 = zip(b1_e42, b0_e36, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        other_v2 = cross(along_e62, across_e73);
        let _e75 = sine_between(along_e62, across_e73);
        sine_v3 = _e75;
    } else {
        differences_v0.d[0] = zip(p_e21, q_e27, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
        differences_v0.count = 1u32;
        let _e84 = differences_v0.d[0];
        let _e88 = [1.0f32, 0.0f32, 0.0f32];
        closest_v1 = Closest { offset: _e84, weights: _e88 };
        if ((pair_e1).kind != 0u32) {
            let _e97 = <[i32; 4]>::load(m.positions, 4 * (((pair_e1).vertices)[2] as usize));
            let r_e98 = swizzle(_e97, [0, 1, 2]);
            differences_v0.d[1] = zip(p_e21, r_e98, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
            differences_v0.count = 2u32;
            if ((pair_e1).kind == 1u32) {
                let _e110 = differences_v0.d[0];
                let _e114 = differences_v0.d[1];
                let _e116 = closest_vertex_edge(_e110.map(|x| (-x)), _e114.map(|x| (-x)));
                closest_v1 = _e116;
            } else {
                let _e121 = <[i32; 4]>::load(m.positions, 4 * (((pair_e1).vertices)[3] as usize));
                let s_e122 = swizzle(_e121, [0, 1, 2]);
                differences_v0.d[2] = zip(p_e21, s_e122, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                differences_v0.count = 3u32;
                let _e131 = differences_v0.d[0];
                let _e135 = differences_v0.d[1];
                let _e139 = differences_v0.d[2];
                let _e141 = closest_vertex_triangle(_e131.map(|x| (-x)), _e135.map(|x| (-x)), _e139.map(|x| (-x)));
                closest_v1 = _e141;
                other_v2 = cross(zip(r_e98, q_e27, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)), zip(s_e122, q_e27, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)));
            }
        }
    }
    'l0: loop {
        'c0: {
            let _e151 = k_v5;
            let _e153 = differences_v0.count;
            if (_e151 < _e153) {
            } else {
                break 'l0;
            }
            {
                let _e155 = largest_v4;
                let _e157 = k_v5;
                let _e159 = differences_v0.d[_e157 as usize];
                let _e160 = size(_e159);
                largest_v4 = _e155.max(_e160);
            }
        }
        let _e162 = k_v5;
        k_v5 = _e162.wrapping_add(1u32);
    }
    let _e167 = largest_v4;
    differences_v0.slack = (3.8146973e-6f32 * _e167);
    let _e170 = closest_v1.offset;
    let _e172 = closest_v1.offset;
    let distance_e174 = dot(_e170, _e172).sqrt();
    let _e176 = closest_v1.weights;
    let mut weights_v6: [f32; 2];
    weights_v6 = swizzle(_e176, [1, 2]);
    if ((pair_e1).kind == 3u32) {
        let _e183 = closest_v1.weights;
        weights_v6 = swizzle(_e183, [0, 2]);
    }
    let _e188 = [0.0f32, 0.0f32, 1.0f32];
    let _e189 = weights_v6;
    let _e190 = sine_v3;
    let mut separation_v7: Separation;
    separation_v7 = Separation { normal: _e188, width: (-1.0f32), weights: _e189, distance: distance_e174, min_separation: 0.0f32, wanted: 0.0f32, sine: _e190, padding_0: 0u32, padding_1: 0u32 };
    if (distance_e174 > 0.0f32) {
        let _e202 = closest_v1.offset;
        separation_v7.normal = zip(_e202, [distance_e174; 3], |x, y| (x / y));
        let _e207 = separation_v7.normal;
        let _e208 = differences_v0;
        let _e209 = width_along(_e207, _e208);
        separation_v7.width = _e209;
    }
    let _e211 = separation_v7.width;
    let mut local_v8: bool;
    if (!(_e211 < (0.9f32 * distance_e174))) {
        local_v8 = (distance_e174 <= 0.0f32);
    } else {
        local_v8 = true;
    }
    let _e221 = local_v8;
    if _e221 {
        let _e222 = other_v2;
        let scale_e223 = size(_e222);
        if (scale_e223 > 0.0f32) {
            let _e226 = other_v2;
            other_v2 = zip(_e226, [scale_e223; 3], |x, y| (x / y));
            let _e229 = other_v2;
            let _e230 = other_v2;
            let _e231 = other_v2;
            other_v2 = zip(_e229, [dot(_e230, _e231).sqrt(); 3], |x, y| (x / y));
            let _e236 = other_v2;
            let _e237 = differences_v0;
            let above_e238 = width_along(_e236, _e237);
            let _e239 = other_v2;
            let _e241 = differences_v0;
            let below_e242 = width_along(_e239.map(|x| (-x)), _e241);
            let _e244 = separation_v7.width;
            if (above_e238 > _e244) {
                let _e247 = other_v2;
                separation_v7.normal = _e247;
                separation_v7.width = above_e238;
            }
            let _e250 = separation_v7.width;
            if (below_e242 > _e250) {
                let _e253 = other_v2;
                separation_v7.normal = _e253.map(|x| (-x));
                separation_v7.width = below_e242;
            }
        }
    }
    let _e256 = separation_v7;
    return _e256;
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
                let _e30 = c_v1;
                let _e32 = <Candidate>::load(m.candidates, 2 * (_e30 as usize));
                let _e33 = separate_pair(m, _e32);
                Stored::store(_e33, m.separations, 12 * (_e27 as usize));
            }
        }
        let _e34 = c_v1;
        c_v1 = _e34.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let edges = bound.read(1);
    let triangles = bound.read(2);
    let planes = bound.read(3);
    let candidates = bound.read(4);
    let mut separations = bound.write(5);
    let mut control = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        edges: &edges,
        triangles: &triangles,
        planes: &planes,
        candidates: &candidates,
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
