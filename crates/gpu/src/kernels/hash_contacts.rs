// Written from `shader/rows/hash_contacts.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "hash_contacts",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/shared/contact.wgsl"),
        include_str!("../../shader/rows/hash_contacts.wgsl"),
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
pub const ON_BORDER: f32 = 1e-6f32;
pub const NOT_PRESSING: u32 = 2147483648u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub mask: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::hash_contacts::*;
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

#[derive(Clone, Copy)]
pub struct Contact {
    pub is_shared: bool,
    pub vertices: [u32; 3],
}

impl Contact {
    const ZERO: Self = Self {
        is_shared: false,
        vertices: [0u32; 3],
    };
}

struct Memory<'a> {
    params: Params,
    edges: &'a [u32],
    triangles: &'a [u32],
    candidates: &'a [u32],
    separations: &'a [u32],
    states: &'a [u32],
    starts: &'a [u32],
    table: &'a mut [u32],
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

pub fn contact_of(m: &mut Memory<'_>, c_a0: u32) -> Contact {
    let mut sides_v1: [u32; 4] = [4294967295u32; 4];
    let mut counts_v2: [u32; 2] = [0u32; 2];
    let mut k_v3: u32 = 0u32;
    let _e3 = <Candidate>::load(m.candidates, 2 * (c_a0 as usize));
    let pair_e4 = pair_of(m, _e3);
    let _e7 = <Separation>::load(m.separations, 12 * (c_a0 as usize));
    let _e8 = signed_weights(pair_e4, _e7);
    let mut weights_v0: [f32; 4];
    weights_v0 = _e8;
    'l0: loop {
        'c0: {
            let _e18 = k_v3;
            if (_e18 < (pair_e4).count) {
            } else {
                break 'l0;
            }
            {
                let _e21 = k_v3;
                let _e23 = weights_v0[_e21 as usize];
                if (_e23.abs() <= 1e-6f32) {
                    break 'c0;
                }
                let _e28 = k_v3;
                let v_e29 = ((pair_e4).vertices)[_e28 as usize];
                let _e30 = k_v3;
                if (_e30 < (pair_e4).side_a) {
                    let _e33 = sides_v1;
                    let _e34 = swizzle(_e33, [1, 2, 3]);
                    let _e37 = sides_v1[0];
                    let _e38 = sides_v1;
                    let _e39 = swizzle(_e38, [2, 3]);
                    let _e42 = counts_v2[0];
                    sides_v1 = (if (_e42 == 1u32) { [_e37, v_e29, (_e39)[0], (_e39)[1]] } else { [v_e29, (_e34)[0], (_e34)[1], (_e34)[2]] });
                    let _e47 = counts_v2[0];
                    counts_v2[0] = _e47.wrapping_add(1u32);
                } else {
                    let _e50 = sides_v1;
                    let _e51 = swizzle(_e50, [0, 1]);
                    let _e53 = sides_v1[3];
                    let _e55 = sides_v1;
                    let _e56 = swizzle(_e55, [0, 1, 2]);
                    let _e59 = counts_v2[1];
                    sides_v1 = (if (_e59 == 1u32) { [(_e56)[0], (_e56)[1], (_e56)[2], v_e29] } else { [(_e51)[0], (_e51)[1], v_e29, _e53] });
                    let _e64 = counts_v2[1];
                    counts_v2[1] = _e64.wrapping_add(1u32);
                }
            }
        }
        let _e67 = k_v3;
        k_v3 = _e67.wrapping_add(1u32);
    }
    let mut local_v4: bool;
    if ((pair_e4).kind != 4u32) {
        let _e76 = counts_v2[0];
        let _e78 = counts_v2[1];
        local_v4 = (_e76.wrapping_add(_e78) <= 3u32);
    } else {
        local_v4 = false;
    }
    let _e83 = local_v4;
    let mut local_v5: bool;
    if _e83 {
        let _e86 = counts_v2;
        local_v5 = all(zip(_e86, [0u32; 2], |x, y| (x > y)));
    } else {
        local_v5 = false;
    }
    let is_shared_e92 = local_v5;
    let _e94 = sides_v1[0];
    let _e96 = sides_v1[1];
    let _e97 = _e94.min(_e96);
    let _e99 = sides_v1[0];
    let _e101 = sides_v1[1];
    let _e102 = _e99.max(_e101);
    let a_e103 = [_e97, _e102];
    let _e105 = sides_v1[2];
    let _e107 = sides_v1[3];
    let _e108 = _e105.min(_e107);
    let _e110 = sides_v1[2];
    let _e112 = sides_v1[3];
    let _e113 = _e110.max(_e112);
    let b_e114 = [_e108, _e113];
    let _e116 = counts_v2[0];
    let mut local_v6: bool;
    if (!(_e116 == 2u32)) {
        let _e123 = counts_v2[1];
        let mut local_v7: bool;
        if (_e123 == 1u32) {
            local_v7 = ((b_e114)[0] < (a_e103)[0]);
        } else {
            local_v7 = false;
        }
        let _e132 = local_v7;
        local_v6 = _e132;
    } else {
        local_v6 = true;
    }
    let swaps_e134 = local_v6;
    let _e135 = (a_e103)[0];
    let _e137 = (b_e114)[0];
    let _e139 = (if swaps_e134 { [_e137, (a_e103)[0], (a_e103)[1]] } else { [_e135, (b_e114)[0], (b_e114)[1]] });
    return Contact { is_shared: is_shared_e92, vertices: _e139 };
}

pub fn place_of(contact_a0: Contact, mask_a1: u32) -> u32 {
    let v_e2 = (contact_a0).vertices;
    let mut hash_v0: u32;
    hash_v0 = (((v_e2)[0].wrapping_mul(2654435761u32) ^ (v_e2)[1].wrapping_mul(2246822507u32).wrapping_add(2146121005u32)) ^ (v_e2)[2].wrapping_mul(3266489909u32));
    let _e17 = hash_v0;
    let _e18 = hash_v0;
    hash_v0 = (_e17 ^ _e18.wrapping_shr(15u32)).wrapping_mul(739982445u32);
    let _e24 = hash_v0;
    let _e25 = hash_v0;
    hash_v0 = (_e24 ^ _e25.wrapping_shr(12u32)).wrapping_mul(695872825u32);
    let _e31 = hash_v0;
    let _e32 = hash_v0;
    return ((_e31 ^ _e32.wrapping_shr(15u32)) & mask_a1);
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
                let _e15 = <u32>::load(m.starts, 1 * (_e13 as usize));
                if (_e15 == 0u32) {
                    break 'c0;
                }
                let _e18 = c_v0;
                let contact_e19 = contact_of(m, _e18);
                if (contact_e19).is_shared {
                    let _e21 = c_v0;
                    let _e24 = c_v0;
                    let _e26 = c_v0;
                    let _e29 = <f32>::load(m.states, 8 * (_e26 as usize) + 3);
                    let number_e32 = (if (_e29 > 0.0f32) { _e24 } else { (_e21 | 2147483648u32) });
                    let _e36 = m.params.mask;
                    let _e37 = place_of(contact_e19, _e36);
                    { let old = <u32>::load(m.table, 1 * (_e37 as usize)); let new = old.min(number_e32); Stored::store(new, m.table, 1 * (_e37 as usize)); old };
                }
            }
        }
        let _e40 = c_v0;
        c_v0 = _e40.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let edges = bound.read(0);
    let triangles = bound.read(1);
    let candidates = bound.read(2);
    let separations = bound.read(3);
    let states = bound.read(4);
    let starts = bound.read(5);
    let mut table = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        edges: &edges,
        triangles: &triangles,
        candidates: &candidates,
        separations: &separations,
        states: &states,
        starts: &starts,
        table: &mut table,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
