// Written from `shader/backward/sweep_edges.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "sweep_edges",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/sweep_edges.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Write, Write],
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
pub const THREADS: u32 = 256u32;
pub const KEPT: u32 = 4u32;
pub const NO_COLOR: u32 = 4294967295u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub first: u32,
    pub end: u32,
    pub only_apply: u32,
    pub sweeps: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::sweep_edges::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct EdgeCluster {
    pub first_vertex: u32,
    pub vertices: u32,
    pub first_edge: u32,
    pub first_color: u32,
    pub colors: u32,
}

impl EdgeCluster {
    const ZERO: Self = Self {
        first_vertex: 0u32,
        vertices: 0u32,
        first_edge: 0u32,
        first_color: 0u32,
        colors: 0u32,
    };
}

impl Stored for EdgeCluster {
    const WORDS: usize = 5;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            first_vertex: <u32>::load(words, at + 0),
            vertices: <u32>::load(words, at + 1),
            first_edge: <u32>::load(words, at + 2),
            first_color: <u32>::load(words, at + 3),
            colors: <u32>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.first_vertex.store(words, at + 0);
        self.vertices.store(words, at + 1);
        self.first_edge.store(words, at + 2);
        self.first_color.store(words, at + 3);
        self.colors.store(words, at + 4);
    }
}

#[derive(Clone, Copy)]
pub struct EdgeLimit {
    pub a: u32,
    pub b: u32,
    pub limit: f32,
    pub places: u32,
    pub multiplier: [f32; 3],
    pub longest: f32,
}

impl EdgeLimit {
    const ZERO: Self = Self {
        a: 0u32,
        b: 0u32,
        limit: 0.0f32,
        places: 0u32,
        multiplier: [0.0f32; 3],
        longest: 0.0f32,
    };
}

impl Stored for EdgeLimit {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            a: <u32>::load(words, at + 0),
            b: <u32>::load(words, at + 1),
            limit: <f32>::load(words, at + 2),
            places: <u32>::load(words, at + 3),
            multiplier: <[f32; 3]>::load(words, at + 4),
            longest: <f32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.a.store(words, at + 0);
        self.b.store(words, at + 1);
        self.limit.store(words, at + 2);
        self.places.store(words, at + 3);
        self.multiplier.store(words, at + 4);
        self.longest.store(words, at + 7);
    }
}

#[derive(Clone, Copy)]
pub struct Edge {
    pub between: [f32; 3],
    pub limit: f32,
    pub multiplier: [f32; 3],
    pub places: u32,
}

impl Edge {
    const ZERO: Self = Self {
        between: [0.0f32; 3],
        limit: 0.0f32,
        multiplier: [0.0f32; 3],
        places: 0u32,
    };
}

impl Stored for Edge {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            between: <[f32; 3]>::load(words, at + 0),
            limit: <f32>::load(words, at + 3),
            multiplier: <[f32; 3]>::load(words, at + 4),
            places: <u32>::load(words, at + 7),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.between.store(words, at + 0);
        self.limit.store(words, at + 3);
        self.multiplier.store(words, at + 4);
        self.places.store(words, at + 7);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    clusters: &'a [u32],
    cluster_vertices: &'a [u32],
    color_ends: &'a [u32],
    limits: &'a mut [u32],
    displacements: &'a mut [u32],
    moved: [[f32; 4]; 256],
    changes: u32,
    is_changing: u32,
}

#[derive(Clone, Copy)]
struct Private {
    outside: [[f32; 4]; 2],
}

pub fn read_edge(m: &mut Memory<'_>, e_a0: u32) -> Edge {
    let edge_e3 = <EdgeLimit>::load(m.limits, 8 * (e_a0 as usize));
    let _e7 = <[i32; 4]>::load(m.positions, 4 * ((edge_e3).a as usize));
    let _e12 = <[i32; 4]>::load(m.positions, 4 * ((edge_e3).b as usize));
    let between_e15 = zip(swizzle(_e7, [0, 1, 2]), swizzle(_e12, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
    let _e16 = (edge_e3).limit;
    let _e17 = (edge_e3).multiplier;
    let _e18 = (edge_e3).places;
    return Edge { between: between_e15, limit: _e16, multiplier: _e17, places: _e18 };
}

pub fn read_outside(m: &mut Memory<'_>, p: &mut Private, e_a0: u32, places_a1: u32) {
    if ((places_a1 & 65535u32) == 65535u32) {
        let _e12 = <u32>::load(m.limits, 8 * (e_a0 as usize));
        let _e14 = <[f32; 4]>::load(m.displacements, 4 * (_e12 as usize));
        p.outside[0] = _e14;
    }
    if (places_a1.wrapping_shr(16u32) == 65535u32) {
        let _e25 = <u32>::load(m.limits, 8 * (e_a0 as usize) + 1);
        let _e27 = <[f32; 4]>::load(m.displacements, 4 * (_e25 as usize));
        p.outside[1] = _e27;
    }
}

pub fn displacement(m: &mut Memory<'_>, p: &mut Private, place_a0: u32, k_a1: u32) -> [f32; 4] {
    if (place_a0 != 65535u32) {
        let _e6 = m.moved[place_a0 as usize];
        return _e6;
    }
    let _e9 = p.outside[k_a1 as usize];
    return _e9;
}

pub fn projected(edge_a0: Edge, a_a1: [f32; 4], b_a2: [f32; 4]) -> [f32; 3] {
    let total_e5 = ((a_a1)[3] + (b_a2)[3]);
    let along_e10 = zip(zip((edge_a0).between, swizzle(a_a1, [0, 1, 2]), |x, y| (x + y)), swizzle(b_a2, [0, 1, 2]), |x, y| (x - y));
    let released_e13 = zip(along_e10, (edge_a0).multiplier.map(|x| (total_e5 * x)), |x, y| (x + y));
    let length_e15 = dot(released_e13, released_e13).sqrt();
    if (length_e15 > (edge_a0).limit) {
        return released_e13.map(|x| (x * ((length_e15 - (edge_a0).limit) / (length_e15 * total_e5))));
    }
    return [0.0f32; 3];
}

pub fn would_change(m: &mut Memory<'_>, p: &mut Private, e_a0: u32, edge_a1: Edge) -> bool {
    read_outside(m, p, e_a0, (edge_a1).places);
    let a_e7 = displacement(m, p, ((edge_a1).places & 65535u32), 0u32);
    let b_e12 = displacement(m, p, (edge_a1).places.wrapping_shr(16u32), 1u32);
    if (((a_e7)[3] + (b_e12)[3]) <= 0.0f32) {
        return false;
    }
    let _e21 = m.params.only_apply;
    if (_e21 != 0u32) {
        return any(zip((edge_a1).multiplier, [0.0f32; 3], |x, y| (x != y)));
    }
    let _e29 = projected(edge_a1, a_e7, b_e12);
    return any(zip(_e29, (edge_a1).multiplier, |x, y| (x != y)));
}

pub fn relax(m: &mut Memory<'_>, p: &mut Private, e_a0: u32, edge_a1: Edge) -> [f32; 3] {
    read_outside(m, p, e_a0, (edge_a1).places);
    let a_place_e5 = ((edge_a1).places & 65535u32);
    let b_place_e8 = (edge_a1).places.wrapping_shr(16u32);
    let a_e10 = displacement(m, p, a_place_e5, 0u32);
    let b_e12 = displacement(m, p, b_place_e8, 1u32);
    if (((a_e10)[3] + (b_e12)[3]) <= 0.0f32) {
        return (edge_a1).multiplier;
    }
    let mut multiplier_v0: [f32; 3];
    multiplier_v0 = (edge_a1).multiplier;
    let _e21 = multiplier_v0;
    let mut change_v1: [f32; 3];
    change_v1 = _e21;
    let _e25 = m.params.only_apply;
    if (_e25 == 0u32) {
        let _e28 = projected(edge_a1, a_e10, b_e12);
        multiplier_v0 = _e28;
        let _e29 = multiplier_v0;
        change_v1 = zip(_e29, (edge_a1).multiplier, |x, y| (x - y));
    }
    if (a_place_e5 != 65535u32) {
        let _e38 = change_v1;
        let _e40 = zip(swizzle(a_e10, [0, 1, 2]), _e38.map(|x| ((a_e10)[3] * x)), |x, y| (x - y));
        let _e41 = (a_e10)[3];
        m.moved[a_place_e5 as usize] = [(_e40)[0], (_e40)[1], (_e40)[2], _e41];
    }
    if (b_place_e8 != 65535u32) {
        let _e49 = change_v1;
        let _e51 = zip(swizzle(b_e12, [0, 1, 2]), _e49.map(|x| ((b_e12)[3] * x)), |x, y| (x + y));
        let _e52 = (b_e12)[3];
        m.moved[b_place_e8 as usize] = [(_e51)[0], (_e51)[1], (_e51)[2], _e52];
    }
    let _e54 = multiplier_v0;
    return _e54;
}

pub fn main(m: &mut Memory<'_>, p: &mut [Private; 256], group: u32) {
    let mut k_v0: u32 = 0u32;
    let mut colors_v1: [[u32; 4]; 256] = [[0u32; 4]; 256];
    let mut last_v2: [u32; 256] = [0u32; 256];
    let mut first_v4: [Edge; 256] = [Edge::ZERO; 256];
    let mut second_v5: [Edge; 256] = [Edge::ZERO; 256];
    let mut third_v6: [Edge; 256] = [Edge::ZERO; 256];
    let mut fourth_v7: [Edge; 256] = [Edge::ZERO; 256];
    let mut sweep_v22: u32 = 0u32;
    let mut start_v23: [u32; 256] = [0u32; 256];
    let mut color_v24: u32 = 0u32;
    let mut cluster_e16: [EdgeCluster; 256] = [EdgeCluster::ZERO; 256];
    let mut v_e19: [u32; 256] = [0u32; 256];
    let mut own_e46: [[u32; 4]; 256] = [[0u32; 4]; 256];
    let mut keeps_e80: [bool; 256] = [false; 256];
    let _e4 = m.params.first;
    k_v0 = _e4.wrapping_add(([group, 0, 0])[0]);
    'l0: loop {
        'c0: {
            let _e8 = k_v0;
            let _e11 = m.params.end;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e14 = k_v0;
                for t in 0..256 {
                    cluster_e16[t] = <EdgeCluster>::load(m.clusters, 5 * (_e14 as usize));
                    v_e19[t] = (cluster_e16[t]).first_vertex.wrapping_add(([t as u32, 0, 0])[0]);
                    if (([t as u32, 0, 0])[0] < (cluster_e16[t]).vertices) {
                        let _e29 = <u32>::load(m.cluster_vertices, 1 * (v_e19[t] as usize));
                        let _e31 = <[f32; 4]>::load(m.displacements, 4 * (_e29 as usize));
                        m.moved[([t as u32, 0, 0])[0] as usize] = _e31;
                    }
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        m.changes = 0u32;
                    }
                    own_e46[t] = zip([(cluster_e16[t]).first_edge.wrapping_add(([t as u32, 0, 0])[0]); 4], [0u32, 256u32, 512u32, 768u32], |x, y| x.wrapping_add(y));
                    colors_v1[t] = [4294967295u32; 4];
                    last_v2[t] = (cluster_e16[t]).first_edge;
                    let mut color_v3: u32;
                    color_v3 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e54 = color_v3;
                            if (_e54 < (cluster_e16[t]).colors) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e59 = color_v3;
                                let end_e62 = <u32>::load(m.color_ends, 1 * ((cluster_e16[t]).first_color.wrapping_add(_e59) as usize));
                                let _e63 = colors_v1[t];
                                let _e64 = color_v3;
                                let _e66 = last_v2[t];
                                colors_v1[t] = select(zip(zip(own_e46[t], [_e66; 4], |x, y| (x >= y)), zip(own_e46[t], [end_e62; 4], |x, y| (x < y)), |x, y| (x & y)), [_e64; 4], _e63);
                                last_v2[t] = end_e62;
                            }
                        }
                        let _e73 = color_v3;
                        color_v3 = _e73.wrapping_add(1u32);
                    }
                    let _e76 = last_v2[t];
                    keeps_e80[t] = (_e76.wrapping_sub((cluster_e16[t]).first_edge) <= 1024u32);
                    first_v4[t] = Edge::ZERO;
                    second_v5[t] = Edge::ZERO;
                    third_v6[t] = Edge::ZERO;
                    fourth_v7[t] = Edge::ZERO;
                    let mut local_v8: bool;
                    if keeps_e80[t] {
                        let _e92 = last_v2[t];
                        local_v8 = ((own_e46[t])[0] < _e92);
                    } else {
                        local_v8 = false;
                    }
                    let _e95 = local_v8;
                    if _e95 {
                        let _e97 = read_edge(m, (own_e46[t])[0]);
                        first_v4[t] = _e97;
                    }
                    let mut local_v9: bool;
                    if keeps_e80[t] {
                        let _e101 = last_v2[t];
                        local_v9 = ((own_e46[t])[1] < _e101);
                    } else {
                        local_v9 = false;
                    }
                    let _e104 = local_v9;
                    if _e104 {
                        let _e106 = read_edge(m, (own_e46[t])[1]);
                        second_v5[t] = _e106;
                    }
                    let mut local_v10: bool;
                    if keeps_e80[t] {
                        let _e110 = last_v2[t];
                        local_v10 = ((own_e46[t])[2] < _e110);
                    } else {
                        local_v10 = false;
                    }
                    let _e113 = local_v10;
                    if _e113 {
                        let _e115 = read_edge(m, (own_e46[t])[2]);
                        third_v6[t] = _e115;
                    }
                    let mut local_v11: bool;
                    if keeps_e80[t] {
                        let _e119 = last_v2[t];
                        local_v11 = ((own_e46[t])[3] < _e119);
                    } else {
                        local_v11 = false;
                    }
                    let _e122 = local_v11;
                    if _e122 {
                        let _e124 = read_edge(m, (own_e46[t])[3]);
                        fourth_v7[t] = _e124;
                    }
                }
                for t in 0..256 {
                    let mut any_changes_v12: bool;
                    any_changes_v12 = false;
                    if keeps_e80[t] {
                        let _e128 = last_v2[t];
                        let mut local_v13: bool;
                        if ((own_e46[t])[0] < _e128) {
                            let _e133 = first_v4[t];
                            let _e134 = would_change(m, &mut p[t], (own_e46[t])[0], _e133);
                            local_v13 = _e134;
                        } else {
                            local_v13 = false;
                        }
                        let _e136 = local_v13;
                        any_changes_v12 = _e136;
                        let _e137 = any_changes_v12;
                        let mut local_v14: bool;
                        if (!_e137) {
                            let _e142 = last_v2[t];
                            let mut local_v15: bool;
                            if ((own_e46[t])[1] < _e142) {
                                let _e147 = second_v5[t];
                                let _e148 = would_change(m, &mut p[t], (own_e46[t])[1], _e147);
                                local_v15 = _e148;
                            } else {
                                local_v15 = false;
                            }
                            let _e150 = local_v15;
                            local_v14 = _e150;
                        } else {
                            local_v14 = true;
                        }
                        let _e152 = local_v14;
                        any_changes_v12 = _e152;
                        let _e153 = any_changes_v12;
                        let mut local_v16: bool;
                        if (!_e153) {
                            let _e158 = last_v2[t];
                            let mut local_v17: bool;
                            if ((own_e46[t])[2] < _e158) {
                                let _e163 = third_v6[t];
                                let _e164 = would_change(m, &mut p[t], (own_e46[t])[2], _e163);
                                local_v17 = _e164;
                            } else {
                                local_v17 = false;
                            }
                            let _e166 = local_v17;
                            local_v16 = _e166;
                        } else {
                            local_v16 = true;
                        }
                        let _e168 = local_v16;
                        any_changes_v12 = _e168;
                        let _e169 = any_changes_v12;
                        let mut local_v18: bool;
                        if (!_e169) {
                            let _e174 = last_v2[t];
                            let mut local_v19: bool;
                            if ((own_e46[t])[3] < _e174) {
                                let _e179 = fourth_v7[t];
                                let _e180 = would_change(m, &mut p[t], (own_e46[t])[3], _e179);
                                local_v19 = _e180;
                            } else {
                                local_v19 = false;
                            }
                            let _e182 = local_v19;
                            local_v18 = _e182;
                        } else {
                            local_v18 = true;
                        }
                        let _e184 = local_v18;
                        any_changes_v12 = _e184;
                    } else {
                        let mut e_v20: u32;
                        e_v20 = (own_e46[t])[0];
                        'l2: loop {
                            'c2: {
                                let _e187 = e_v20;
                                let _e188 = last_v2[t];
                                let mut local_v21: bool;
                                if (_e187 < _e188) {
                                    let _e192 = any_changes_v12;
                                    local_v21 = (!_e192);
                                } else {
                                    local_v21 = false;
                                }
                                let _e195 = local_v21;
                                if _e195 {
                                } else {
                                    break 'l2;
                                }
                                {
                                    let _e196 = e_v20;
                                    let _e197 = e_v20;
                                    let _e198 = read_edge(m, _e197);
                                    let _e199 = would_change(m, &mut p[t], _e196, _e198);
                                    any_changes_v12 = _e199;
                                }
                            }
                            let _e200 = e_v20;
                            e_v20 = _e200.wrapping_add(256u32);
                        }
                    }
                    let _e203 = any_changes_v12;
                    if _e203 {
                        m.changes = 1u32;
                    }
                }
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        let _e211 = m.changes;
                        m.is_changing = _e211;
                    }
                }
                let _e213 = { let t = 0; m.is_changing };
                if (_e213 == 0u32) {
                    break 'c0;
                }
                sweep_v22 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e218 = sweep_v22;
                        let _e221 = m.params.sweeps;
                        if (_e218 < _e221) {
                        } else {
                            break 'l3;
                        }
                        {
                            for t in 0..256 {
                                start_v23[t] = (cluster_e16[t]).first_edge;
                            }
                            color_v24 = 0u32;
                            'l4: loop {
                                'c4: {
                                    let _e227 = color_v24;
                                    if uniform(std::array::from_fn::<_, 256, _>(|t| (_e227 < (cluster_e16[t]).colors))) {
                                    } else {
                                        break 'l4;
                                    }
                                    {
                                        for t in 0..256 {
                                            if keeps_e80[t] {
                                                let _e230 = colors_v1[t];
                                                let _e231 = color_v24;
                                                let is_of_e233 = zip(_e230, [_e231; 4], |x, y| (x == y));
                                                if any(is_of_e233) {
                                                    let mut e_v25: u32;
                                                    e_v25 = (own_e46[t])[0];
                                                    let _e237 = first_v4[t];
                                                    let mut edge_v26: Edge;
                                                    edge_v26 = _e237;
                                                    if (is_of_e233)[1] {
                                                        e_v25 = (own_e46[t])[1];
                                                        let _e241 = second_v5[t];
                                                        edge_v26 = _e241;
                                                    }
                                                    if (is_of_e233)[2] {
                                                        e_v25 = (own_e46[t])[2];
                                                        let _e244 = third_v6[t];
                                                        edge_v26 = _e244;
                                                    }
                                                    if (is_of_e233)[3] {
                                                        e_v25 = (own_e46[t])[3];
                                                        let _e247 = fourth_v7[t];
                                                        edge_v26 = _e247;
                                                    }
                                                    let _e248 = e_v25;
                                                    let _e249 = edge_v26;
                                                    let multiplier_e250 = relax(m, &mut p[t], _e248, _e249);
                                                    let _e253 = first_v4[t].multiplier;
                                                    first_v4[t].multiplier = (if (is_of_e233)[0] { multiplier_e250 } else { _e253 });
                                                    let _e258 = second_v5[t].multiplier;
                                                    second_v5[t].multiplier = (if (is_of_e233)[1] { multiplier_e250 } else { _e258 });
                                                    let _e263 = third_v6[t].multiplier;
                                                    third_v6[t].multiplier = (if (is_of_e233)[2] { multiplier_e250 } else { _e263 });
                                                    let _e268 = fourth_v7[t].multiplier;
                                                    fourth_v7[t].multiplier = (if (is_of_e233)[3] { multiplier_e250 } else { _e268 });
                                                }
                                            } else {
                                                let _e273 = color_v24;
                                                let end_e276 = <u32>::load(m.color_ends, 1 * ((cluster_e16[t]).first_color.wrapping_add(_e273) as usize));
                                                let _e277 = start_v23[t];
                                                let mut e_v27: u32;
                                                e_v27 = _e277.wrapping_add(([t as u32, 0, 0])[0]);
                                                'l5: loop {
                                                    'c5: {
                                                        let _e281 = e_v27;
                                                        if (_e281 < end_e276) {
                                                        } else {
                                                            break 'l5;
                                                        }
                                                        {
                                                            let _e283 = e_v27;
                                                            let _e284 = e_v27;
                                                            let _e285 = read_edge(m, _e284);
                                                            let multiplier_e286 = relax(m, &mut p[t], _e283, _e285);
                                                            let _e289 = m.params.only_apply;
                                                            if (_e289 == 0u32) {
                                                                let _e293 = e_v27;
                                                                Stored::store(multiplier_e286, m.limits, 8 * (_e293 as usize) + 4);
                                                            }
                                                        }
                                                    }
                                                    let _e296 = e_v27;
                                                    e_v27 = _e296.wrapping_add(256u32);
                                                }
                                                start_v23[t] = end_e276;
                                            }
                                        }
                                    }
                                }
                                let _e299 = color_v24;
                                color_v24 = _e299.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e302 = sweep_v22;
                    sweep_v22 = _e302.wrapping_add(1u32);
                }
                for t in 0..256 {
                    let mut local_v28: bool;
                    if keeps_e80[t] {
                        let _e309 = m.params.only_apply;
                        local_v28 = (_e309 == 0u32);
                    } else {
                        local_v28 = false;
                    }
                    let _e313 = local_v28;
                    if _e313 {
                        let _e315 = last_v2[t];
                        if ((own_e46[t])[0] < _e315) {
                            let _e322 = first_v4[t].multiplier;
                            Stored::store(_e322, m.limits, 8 * ((own_e46[t])[0] as usize) + 4);
                        }
                        let _e324 = last_v2[t];
                        if ((own_e46[t])[1] < _e324) {
                            let _e331 = second_v5[t].multiplier;
                            Stored::store(_e331, m.limits, 8 * ((own_e46[t])[1] as usize) + 4);
                        }
                        let _e333 = last_v2[t];
                        if ((own_e46[t])[2] < _e333) {
                            let _e340 = third_v6[t].multiplier;
                            Stored::store(_e340, m.limits, 8 * ((own_e46[t])[2] as usize) + 4);
                        }
                        let _e342 = last_v2[t];
                        if ((own_e46[t])[3] < _e342) {
                            let _e349 = fourth_v7[t].multiplier;
                            Stored::store(_e349, m.limits, 8 * ((own_e46[t])[3] as usize) + 4);
                        }
                    }
                    if (([t as u32, 0, 0])[0] < (cluster_e16[t]).vertices) {
                        let _e356 = <u32>::load(m.cluster_vertices, 1 * (v_e19[t] as usize));
                        let _e361 = m.moved[([t as u32, 0, 0])[0] as usize];
                        Stored::store(_e361, m.displacements, 4 * (_e356 as usize));
                    }
                }
            }
        }
        let _e362 = k_v0;
        k_v0 = _e362.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let clusters = bound.read(1);
    let cluster_vertices = bound.read(2);
    let color_ends = bound.read(3);
    let mut limits = bound.write(4);
    let mut displacements = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        clusters: &clusters,
        cluster_vertices: &cluster_vertices,
        color_ends: &color_ends,
        limits: &mut limits,
        displacements: &mut displacements,
        moved: [[0.0f32; 4]; 256],
        changes: 0u32,
        is_changing: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.moved = [[0.0f32; 4]; 256];
        m.changes = 0u32;
        m.is_changing = 0u32;
        let mut p = [Private { outside: [[0.0f32; 4]; 2], }; 256];
        main(&mut m, &mut p, group as u32);
    }
}
}
