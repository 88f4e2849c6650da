// Written from `shader/backward/coarse_sums.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "coarse_sums",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/coarse_sums.wgsl"),
    ],
    workgroup: 256,
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
pub const SLIDES: f32 = 0.999999f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
    pub capacity: u32,
    pub limits: u32,
    pub vertices: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::coarse_sums::*;
use crate::wgsl::*;

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

struct Memory<'a> {
    params: Params,
    rows: &'a [u32],
    limits: &'a [u32],
    positions: &'a [u32],
    targets: &'a [u32],
    vertices: &'a [u32],
    displacements: &'a [u32],
    control: &'a mut [u32],
    sums: &'a mut [u32],
    shared_sums: [[f32; 2]; 256],
}

pub fn of_row(m: &mut Memory<'_>, r_a0: u32) -> f32 {
    let mut relative_v0: [f32; 3] = [0.0f32; 3];
    let mut k_v1: u32 = 0u32;
    let row_e3 = <Row>::load(m.rows, 24 * (r_a0 as usize));
    if ((row_e3).multiplier <= 0.0f32) {
        return 0.0f32;
    }
    'l0: loop {
        'c0: {
            let _e13 = k_v1;
            if (_e13 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e16 = relative_v0;
                let _e18 = k_v1;
                let _e22 = k_v1;
                let _e25 = <[f32; 4]>::load(m.displacements, 4 * (((row_e3).vertices)[_e22 as usize] as usize));
                relative_v0 = zip(_e16, swizzle(_e25, [0, 1, 2]).map(|x| (((row_e3).weights)[_e18 as usize] * x)), |x, y| (x + y));
            }
        }
        let _e29 = k_v1;
        k_v1 = _e29.wrapping_add(1u32);
    }
    let _e35 = relative_v0;
    let mut slack_v2: f32;
    slack_v2 = ((row_e3).multiplier * ((row_e3).value + dot((row_e3).normal, _e35)));
    let friction_e43 = dot((row_e3).friction, (row_e3).friction).sqrt();
    let mut local_v3: bool;
    if (friction_e43 > 0.0f32) {
        local_v3 = (friction_e43 < ((0.999999f32 * (row_e3).coefficient) * (row_e3).multiplier));
    } else {
        local_v3 = false;
    }
    let _e55 = local_v3;
    if _e55 {
        let _e56 = slack_v2;
        let _e59 = relative_v0;
        slack_v2 = (_e56 + dot((row_e3).friction, zip((row_e3).slip, _e59, |x, y| (x + y))));
    }
    let _e63 = slack_v2;
    return _e63;
}

pub fn of_limit(m: &mut Memory<'_>, e_a0: u32) -> f32 {
    let edge_e3 = <EdgeLimit>::load(m.limits, 8 * (e_a0 as usize));
    let _e7 = <[i32; 4]>::load(m.positions, 4 * ((edge_e3).a as usize));
    let _e12 = <[i32; 4]>::load(m.positions, 4 * ((edge_e3).b as usize));
    let _e19 = <[f32; 4]>::load(m.displacements, 4 * ((edge_e3).a as usize));
    let _e25 = <[f32; 4]>::load(m.displacements, 4 * ((edge_e3).b as usize));
    let along_e27 = zip(zip(zip(swizzle(_e7, [0, 1, 2]), swizzle(_e12, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)), swizzle(_e19, [0, 1, 2]), |x, y| (x + y)), swizzle(_e25, [0, 1, 2]), |x, y| (x - y));
    let f_e28 = (edge_e3).multiplier;
    return (((edge_e3).limit * dot(f_e28, f_e28).sqrt()) - dot(f_e28, along_e27));
}

pub fn of_vertex(m: &mut Memory<'_>, v_a0: u32) -> f32 {
    let displacement_e3 = <[f32; 4]>::load(m.displacements, 4 * (v_a0 as usize));
    if ((displacement_e3)[3] == 0.0f32) {
        return 0.0f32;
    }
    let _e10 = <[i32; 4]>::load(m.targets, 4 * (v_a0 as usize));
    let _e14 = <[i32; 4]>::load(m.positions, 4 * (v_a0 as usize));
    let wanted_e17 = zip(swizzle(_e10, [0, 1, 2]), swizzle(_e14, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
    let _e23 = <f32>::load(m.vertices, 12 * (v_a0 as usize) + 10);
    let moved_e26 = zip(swizzle(displacement_e3, [0, 1, 2]), wanted_e17.map(|x| (x * ((displacement_e3)[3] * _e23))), |x, y| (x - y));
    return (dot(moved_e26, moved_e26) / (displacement_e3)[3]);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut sum_v0: [[f32; 2]; 256] = [[0.0f32; 2]; 256];
    let mut reach_v4: u32 = 128u32;
    let _e7 = m.params.capacity;
    let _e12 = m.params.blocks;
    let stride_e13 = 256u32.wrapping_mul(_e12);
    for t in 0..256 {
        let _e4 = <u32>::load(m.control, 14);
        let row_count_e8 = _e4.min(_e7);
        let first_e18 = 256u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(([t as u32, 0, 0])[0]);
        let mut r_v1: u32;
        r_v1 = first_e18;
        'l0: loop {
            'c0: {
                let _e23 = r_v1;
                if (_e23 < row_count_e8) {
                } else {
                    break 'l0;
                }
                {
                    let _e26 = sum_v0[t][0];
                    let _e27 = r_v1;
                    let _e28 = of_row(m, _e27);
                    sum_v0[t][0] = (_e26 + _e28);
                }
            }
            let _e30 = r_v1;
            r_v1 = _e30.wrapping_add(stride_e13);
        }
        let mut e_v2: u32;
        e_v2 = first_e18;
        'l1: loop {
            'c1: {
                let _e33 = e_v2;
                let _e36 = m.params.limits;
                if (_e33 < _e36) {
                } else {
                    break 'l1;
                }
                {
                    let _e39 = sum_v0[t][0];
                    let _e40 = e_v2;
                    let _e41 = of_limit(m, _e40);
                    sum_v0[t][0] = (_e39 + _e41);
                }
            }
            let _e43 = e_v2;
            e_v2 = _e43.wrapping_add(stride_e13);
        }
        let mut v_v3: u32;
        v_v3 = first_e18;
        'l2: loop {
            'c2: {
                let _e46 = v_v3;
                let _e49 = m.params.vertices;
                if (_e46 < _e49) {
                } else {
                    break 'l2;
                }
                {
                    let _e52 = sum_v0[t][1];
                    let _e53 = v_v3;
                    let _e54 = of_vertex(m, _e53);
                    sum_v0[t][1] = (_e52 + _e54);
                }
            }
            let _e56 = v_v3;
            v_v3 = _e56.wrapping_add(stride_e13);
        }
        let _e61 = sum_v0[t];
        m.shared_sums[([t as u32, 0, 0])[0] as usize] = _e61;
    }
    'l3: loop {
        'c3: {
            let _e64 = reach_v4;
            if (_e64 > 0u32) {
            } else {
                break 'l3;
            }
            {
                let _e68 = reach_v4;
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] < _e68) {
                        let _e73 = m.shared_sums[([t as u32, 0, 0])[0] as usize];
                        let _e76 = reach_v4;
                        let _e79 = m.shared_sums[([t as u32, 0, 0])[0].wrapping_add(_e76) as usize];
                        m.shared_sums[([t as u32, 0, 0])[0] as usize] = zip(_e73, _e79, |x, y| (x + y));
                    }
                }
            }
        }
        let _e81 = reach_v4;
        reach_v4 = (_e81 / 2u32);
    }
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e92 = m.shared_sums[0];
            Stored::store(_e92, m.sums, 2 * (([group, 0, 0])[0] as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let rows = bound.read(0);
    let limits = bound.read(1);
    let positions = bound.read(2);
    let targets = bound.read(3);
    let vertices = bound.read(4);
    let displacements = bound.read(5);
    let mut control = bound.write(6);
    let mut sums = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        rows: &rows,
        limits: &limits,
        positions: &positions,
        targets: &targets,
        vertices: &vertices,
        displacements: &displacements,
        control: &mut control,
        sums: &mut sums,
        shared_sums: [[0.0f32; 2]; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [[0.0f32; 2]; 256];
        main(&mut m, group as u32);
    }
}
}
