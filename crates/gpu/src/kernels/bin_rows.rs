// Written from `shader/backward/bin_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "bin_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/bin_rows.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write],
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
pub const LATTICES: u32 = 4u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
    pub shift: u32,
    pub buckets: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::bin_rows::*;
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

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    displacements: &'a [u32],
    rows: &'a mut [u32],
    tally: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn hash(cell_a0: [i32; 3]) -> u32 {
    let c_e1 = cell_a0.map(|x| (x as u32));
    return (((c_e1)[0].wrapping_mul(73856093u32) ^ (c_e1)[1].wrapping_mul(19349663u32)) ^ (c_e1)[2].wrapping_mul(83492791u32));
}

pub fn bucket_of(m: &mut Memory<'_>, row_a0: Row) -> u32 {
    let mut low_v0: [i32; 3] = [2147483647i32; 3];
    let mut high_v1: [i32; 3] = [(-2147483647i32); 3];
    let mut k_v2: u32 = 0u32;
    let mut lattice_v3: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e9 = k_v2;
            if (_e9 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e13 = k_v2;
                let v_e14 = ((row_a0).vertices)[_e13 as usize];
                let _e18 = <f32>::load(m.displacements, 4 * (v_e14 as usize) + 3);
                if (_e18 > 0.0f32) {
                    let _e21 = low_v0;
                    let _e24 = <[i32; 4]>::load(m.positions, 4 * (v_e14 as usize));
                    low_v0 = zip(_e21, swizzle(_e24, [0, 1, 2]), |x, y| x.min(y));
                    let _e27 = high_v1;
                    let _e30 = <[i32; 4]>::load(m.positions, 4 * (v_e14 as usize));
                    high_v1 = zip(_e27, swizzle(_e30, [0, 1, 2]), |x, y| x.max(y));
                }
            }
        }
        let _e33 = k_v2;
        k_v2 = _e33.wrapping_add(1u32);
    }
    let _e37 = low_v0[0];
    let _e39 = high_v1[0];
    if (_e37 > _e39) {
        return 0u32;
    }
    let _e44 = m.params.buckets;
    if (_e44 > 0u32) {
        'l1: loop {
            'c1: {
                let _e49 = lattice_v3;
                if (_e49 < 4u32) {
                } else {
                    break 'l1;
                }
                {
                    let _e52 = lattice_v3;
                    let _e55 = m.params.shift;
                    let offset_e60 = [(_e52.wrapping_shl(_e55.wrapping_sub(2u32)) as i32); 3];
                    let _e61 = low_v0;
                    let _e65 = m.params.shift;
                    let cell_e67 = zip(zip(_e61, offset_e60, |x, y| x.wrapping_add(y)), [_e65; 3], |x, y| x.wrapping_shr(y));
                    let _e68 = high_v1;
                    let _e72 = m.params.shift;
                    if all(zip(cell_e67, zip(zip(_e68, offset_e60, |x, y| x.wrapping_add(y)), [_e72; 3], |x, y| x.wrapping_shr(y)), |x, y| (x == y))) {
                        let _e77 = lattice_v3;
                        let _e80 = m.params.buckets;
                        let _e82 = hash(cell_e67);
                        let _e85 = m.params.buckets;
                        return _e77.wrapping_mul(_e80).wrapping_add((_e82 & _e85.wrapping_sub(1u32)));
                    }
                }
            }
            let _e90 = lattice_v3;
            lattice_v3 = _e90.wrapping_add(1u32);
        }
    }
    let _e96 = m.params.buckets;
    return 4u32.wrapping_mul(_e96);
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 14);
    let _e6 = m.params.capacity;
    let count_e7 = _e3.min(_e6);
    let mut r_v0: u32;
    r_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = r_v0;
            if (_e10 < count_e7) {
            } else {
                break 'l0;
            }
            {
                let _e13 = r_v0;
                let row_e15 = <Row>::load(m.rows, 24 * (_e13 as usize));
                let mut diagonal_v1: f32;
                diagonal_v1 = 0.0f32;
                let mut k_v2: u32;
                k_v2 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e20 = k_v2;
                        if (_e20 < 4u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e23 = diagonal_v1;
                            let _e26 = k_v2;
                            let _e30 = <f32>::load(m.displacements, 4 * (((row_e15).vertices)[_e26 as usize] as usize) + 3);
                            let _e32 = k_v2;
                            let _e36 = k_v2;
                            diagonal_v1 = (_e23 + ((_e30 * ((row_e15).weights)[_e32 as usize]) * ((row_e15).weights)[_e36 as usize]));
                        }
                    }
                    let _e40 = k_v2;
                    k_v2 = _e40.wrapping_add(1u32);
                }
                let bucket_e43 = bucket_of(m, row_e15);
                let _e45 = r_v0;
                let _e48 = diagonal_v1;
                let _e51 = diagonal_v1;
                Stored::store((if (_e51 > 0.0f32) { (1.0f32 / _e48) } else { 0.0f32 }), m.rows, 24 * (_e45 as usize) + 12);
                let _e57 = r_v0;
                Stored::store(bucket_e43, m.rows, 24 * (_e57 as usize) + 23);
                { let old = <u32>::load(m.tally, 1 * (bucket_e43 as usize)); let new = old.wrapping_add(1u32); Stored::store(new, m.tally, 1 * (bucket_e43 as usize)); old };
            }
        }
        let _e64 = r_v0;
        r_v0 = _e64.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let displacements = bound.read(1);
    let mut rows = bound.write(2);
    let mut tally = bound.write(3);
    let mut control = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        displacements: &displacements,
        rows: &mut rows,
        tally: &mut tally,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
