// Written from `shader/forward/limit_step_sizes.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "limit_step_sizes",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/forward/limit_step_sizes.wgsl"),
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
pub const STEP: f32 = 8.0f32;
pub const PATH_ROUNDING: f32 = 3.8146973e-6f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub damping: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::limit_step_sizes::*;
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
    edges: &'a [u32],
    triangles: &'a [u32],
    vertices: &'a [u32],
    candidates: &'a [u32],
    separations: &'a [u32],
    paths: &'a [u32],
    alphas: &'a mut [u32],
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

pub fn lower(m: &mut Memory<'_>, v_a0: u32, alpha_a1: f32) {
    let mut bits_v0: u32;
    bits_v0 = alpha_a1.to_bits();
    let _e4 = bits_v0;
    if (_e4 >= 2139095040u32) {
        bits_v0 = 0u32;
    }
    let _e10 = bits_v0;
    { let old = <u32>::load(m.alphas, 1 * (v_a0 as usize)); let new = old.min(_e10); Stored::store(new, m.alphas, 1 * (v_a0 as usize)); old };
}

pub fn limit_pair(m: &mut Memory<'_>, candidate_a0: Candidate, separation_a1: Separation) {
    let mut longest_v0: f32 = 0.0f32;
    let mut path_v1: [[f32; 4]; 4] = [[0.0f32; 4]; 4];
    let mut k_v2: u32 = 0u32;
    let mut k_v3: u32 = 0u32;
    let mut closing_v4: [f32; 4] = [0.0f32; 4];
    let mut speeds_v5: [f32; 2] = [0.0f32; 2];
    let mut extremes_v6: [f32; 2] = [(-3e38f32); 2];
    let mut k_v8: u32 = 0u32;
    let mut k_v10: u32 = 0u32;
    let mut k_v11: u32 = 0u32;
    let pair_e2 = pair_of(m, candidate_a0);
    'l0: loop {
        'c0: {
            let _e8 = k_v2;
            if (_e8 < (pair_e2).count) {
            } else {
                break 'l0;
            }
            {
                let _e11 = k_v2;
                let _e15 = k_v2;
                let _e18 = <[f32; 4]>::load(m.paths, 4 * (((pair_e2).vertices)[_e15 as usize] as usize));
                path_v1[_e11 as usize] = _e18;
                let _e19 = longest_v0;
                let _e20 = k_v2;
                let _e23 = path_v1[_e20 as usize][0];
                let _e25 = k_v2;
                let _e28 = path_v1[_e25 as usize][1];
                let _e31 = k_v2;
                let _e34 = path_v1[_e31 as usize][2];
                longest_v0 = _e19.max(((_e23.abs() + _e28.abs()) + _e34.abs()));
            }
        }
        let _e38 = k_v2;
        k_v2 = _e38.wrapping_add(1u32);
    }
    let _e41 = longest_v0;
    if (_e41 == 0.0f32) {
        return;
    }
    let _e46 = longest_v0;
    let rounding_e48 = (8.0f32 + (3.8146973e-6f32 * _e46));
    if (!((separation_a1).width > (2.0f32 * rounding_e48))) {
        'l1: loop {
            'c1: {
                let _e56 = k_v3;
                if (_e56 < (pair_e2).count) {
                } else {
                    break 'l1;
                }
                {
                    let _e60 = k_v3;
                    lower(m, ((pair_e2).vertices)[_e60 as usize], 0.0f32);
                }
            }
            let _e63 = k_v3;
            k_v3 = _e63.wrapping_add(1u32);
        }
        { let old = <u32>::load(m.control, 2); let new = old.wrapping_add(1u32); Stored::store(new, m.control, 2); old };
        return;
    }
    let _e72 = m.params.damping;
    let allowed_e79 = ((_e72 * ((separation_a1).width - (separation_a1).min_separation)) - rounding_e48).max(0.0f32);
    let group_e92 = <u32>::load(m.vertices, 12 * (((pair_e2).vertices)[0] as usize) + 6);
    let mut one_group_v7: bool;
    one_group_v7 = (group_e92 != 4294967295u32);
    'l2: loop {
        'c2: {
            let _e98 = k_v8;
            if (_e98 < (pair_e2).count) {
            } else {
                break 'l2;
            }
            {
                let _e102 = k_v8;
                let _e104 = path_v1[_e102 as usize];
                let along_e106 = dot((separation_a1).normal, swizzle(_e104, [0, 1, 2]));
                let _e107 = k_v8;
                let side_e110 = u32::from((_e107 >= (pair_e2).side_a));
                let _e111 = k_v8;
                closing_v4[_e111 as usize] = (if (side_e110 == 0u32) { (-along_e106) } else { along_e106 });
                let _e119 = speeds_v5[side_e110 as usize];
                let _e120 = k_v8;
                let _e122 = closing_v4[_e120 as usize];
                speeds_v5[side_e110 as usize] = _e119.max(_e122);
                let _e126 = extremes_v6[side_e110 as usize];
                let _e127 = k_v8;
                let _e129 = closing_v4[_e127 as usize];
                extremes_v6[side_e110 as usize] = _e126.max(_e129);
                let _e131 = one_group_v7;
                let mut local_v9: bool;
                if _e131 {
                    let _e136 = k_v8;
                    let _e140 = <u32>::load(m.vertices, 12 * (((pair_e2).vertices)[_e136 as usize] as usize) + 6);
                    local_v9 = (_e140 == group_e92);
                } else {
                    local_v9 = false;
                }
                let _e143 = local_v9;
                one_group_v7 = _e143;
            }
        }
        let _e144 = k_v8;
        k_v8 = _e144.wrapping_add(1u32);
    }
    let _e147 = one_group_v7;
    if _e147 {
        let _e149 = extremes_v6[0];
        let _e151 = extremes_v6[1];
        let total_e157 = (_e149 + (if ((pair_e2).side_a == (pair_e2).count) { 0.0f32 } else { _e151 }));
        if (total_e157 > allowed_e79) {
            'l3: loop {
                'c3: {
                    let _e161 = k_v10;
                    if (_e161 < (pair_e2).count) {
                    } else {
                        break 'l3;
                    }
                    {
                        let _e165 = k_v10;
                        let _e168 = k_v10;
                        let _e171 = path_v1[_e168 as usize][3];
                        lower(m, ((pair_e2).vertices)[_e165 as usize], ((allowed_e79 / total_e157) * _e171));
                    }
                }
                let _e173 = k_v10;
                k_v10 = _e173.wrapping_add(1u32);
            }
        }
        return;
    }
    let _e177 = speeds_v5[0];
    let _e179 = speeds_v5[1];
    let total_e180 = (_e177 + _e179);
    if (total_e180 <= allowed_e79) {
        return;
    }
    'l4: loop {
        'c4: {
            let _e184 = k_v11;
            if (_e184 < (pair_e2).count) {
            } else {
                break 'l4;
            }
            {
                let _e187 = k_v11;
                let _e189 = closing_v4[_e187 as usize];
                if (_e189 > 0.0f32) {
                    let _e192 = k_v11;
                    let _e197 = speeds_v5[u32::from((_e192 >= (pair_e2).side_a)) as usize];
                    let share_e198 = (_e197 / total_e180);
                    let _e200 = k_v11;
                    let _e203 = k_v11;
                    let _e205 = closing_v4[_e203 as usize];
                    let _e209 = k_v11;
                    let _e212 = path_v1[_e209 as usize][3];
                    lower(m, ((pair_e2).vertices)[_e200 as usize], (((allowed_e79 * share_e198) / _e205).min(1.0f32) * _e212));
                }
            }
        }
        let _e214 = k_v11;
        k_v11 = _e214.wrapping_add(1u32);
    }
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
                let _e15 = <Candidate>::load(m.candidates, 2 * (_e13 as usize));
                let _e17 = c_v0;
                let _e19 = <Separation>::load(m.separations, 12 * (_e17 as usize));
                limit_pair(m, _e15, _e19);
            }
        }
        let _e20 = c_v0;
        c_v0 = _e20.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let edges = bound.read(0);
    let triangles = bound.read(1);
    let vertices = bound.read(2);
    let candidates = bound.read(3);
    let separations = bound.read(4);
    let paths = bound.read(5);
    let mut alphas = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        edges: &edges,
        triangles: &triangles,
        vertices: &vertices,
        candidates: &candidates,
        separations: &separations,
        paths: &paths,
        alphas: &mut alphas,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
