// Written from `shader/rows/compact_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "compact_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/weights.wgsl"),
        include_str!("../../shader/shared/pair.wgsl"),
        include_str!("../../shader/rows/compact_rows.wgsl"),
    ],
    workgroup: 256,
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::compact_rows::*;
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
    starts: &'a [u32],
    candidates: &'a [u32],
    rows: &'a mut [u32],
    pairs: &'a mut [u32],
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
                let place_e15 = <u32>::load(m.starts, 1 * (_e13 as usize));
                let _e17 = c_v0;
                let _e21 = <u32>::load(m.starts, 1 * (_e17.wrapping_add(1u32) as usize));
                if (_e21 > place_e15) {
                    let _e24 = c_v0;
                    let _e26 = <Candidate>::load(m.candidates, 2 * (_e24 as usize));
                    let _e27 = pair_of(m, _e26);
                    let v_e28 = (_e27).vertices;
                    let _e32 = (v_e28)[0];
                    let _e33 = (v_e28)[1];
                    let _e34 = (v_e28)[2];
                    let _e35 = (v_e28)[3];
                    Stored::store([_e32, _e33, _e34, _e35], m.rows, 24 * (place_e15 as usize));
                    let _e40 = c_v0;
                    Stored::store(_e40, m.rows, 24 * (place_e15 as usize) + 14);
                    let _e44 = c_v0;
                    let _e46 = <Candidate>::load(m.candidates, 2 * (_e44 as usize));
                    Stored::store(_e46, m.pairs, 2 * (place_e15 as usize));
                }
            }
        }
        let _e47 = c_v0;
        c_v0 = _e47.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let edges = bound.read(0);
    let triangles = bound.read(1);
    let starts = bound.read(2);
    let candidates = bound.read(3);
    let mut rows = bound.write(4);
    let mut pairs = bound.write(5);
    let mut control = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        edges: &edges,
        triangles: &triangles,
        starts: &starts,
        candidates: &candidates,
        rows: &mut rows,
        pairs: &mut pairs,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
