// Written from `shader/backward/attainable_distances.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "attainable_distances",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/attainable_distances.wgsl"),
    ],
    workgroup: 128,
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
pub const ROUNDING: f32 = 9.536743e-7f32;
pub const ON_GRID: f32 = 4.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::attainable_distances::*;
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
    candidates: &'a [u32],
    separations: &'a [u32],
    rows: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn lacking_of(first_a0: u32, end_a1: u32, opposite_a2: [f32; 3], outward_a3: [f32; 3], wanted_a4: f32, rounding_a5: f32, places_a6: &mut [[f32; 4]; 4], weights_a7: &mut [f32; 4]) -> f32 {
    let mut any_free_v1: bool = false;
    let mut any_prescribed_v2: bool = false;
    let mut lacking_v0: f32;
    lacking_v0 = rounding_a5;
    let mut k_v3: u32;
    k_v3 = first_a0;
    'l0: loop {
        'c0: {
            let _e14 = k_v3;
            if (_e14 < end_a1) {
            } else {
                break 'l0;
            }
            {
                let _e16 = k_v3;
                let place_e18 = (*places_a6)[_e16 as usize];
                if ((place_e18)[3] != 0.0f32) {
                    any_free_v1 = true;
                    break 'c0;
                }
                any_prescribed_v2 = true;
                let _e24 = lacking_v0;
                let _e25 = k_v3;
                let _e27 = (*weights_a7)[_e25 as usize];
                lacking_v0 = (_e24 + (_e27.abs() * (wanted_a4 - dot(outward_a3, zip(swizzle(place_e18, [0, 1, 2]), opposite_a2, |x, y| (x - y)))).max(0.0f32)));
            }
        }
        let _e37 = k_v3;
        k_v3 = _e37.wrapping_add(1u32);
    }
    let _e40 = lacking_v0;
    let _e41 = any_free_v1;
    let mut local_v4: bool;
    if _e41 {
        let _e44 = any_prescribed_v2;
        local_v4 = _e44;
    } else {
        local_v4 = false;
    }
    let _e46 = local_v4;
    return (if _e46 { _e40 } else { 0.0f32 });
}

pub fn lower_target(m: &mut Memory<'_>, r_a0: u32) {
    let mut places_v1: [[f32; 4]; 4] = [[0.0f32; 4]; 4];
    let mut weights_v2: [f32; 4] = [0.0f32; 4];
    let mut means_v3: [[f32; 3]; 2] = [[0.0f32; 3]; 2];
    let mut longest_v4: f32 = 0.0f32;
    let mut k_v5: u32 = 0u32;
    let row_e3 = <Row>::load(m.rows, 24 * (r_a0 as usize));
    let _e8 = <u32>::load(m.candidates, 2 * ((row_e3).candidate as usize));
    let kind_e10 = _e8.wrapping_shr(29u32);
    let mut local_v0: bool;
    if (!(kind_e10 == 0u32)) {
        local_v0 = (kind_e10 == 4u32);
    } else {
        local_v0 = true;
    }
    let _e19 = local_v0;
    if _e19 {
        return;
    }
    let count_e24 = (if (kind_e10 == 1u32) { 3u32 } else { 4u32 });
    let side_a_e29 = (if (kind_e10 == 3u32) { 2u32 } else { 1u32 });
    let wanted_e34 = <f32>::load(m.separations, 12 * ((row_e3).candidate as usize) + 8);
    let _e39 = <[i32; 4]>::load(m.positions, 4 * (((row_e3).vertices)[0] as usize));
    let origin_e40 = swizzle(_e39, [0, 1, 2]);
    'l0: loop {
        'c0: {
            let _e48 = k_v5;
            if (_e48 < count_e24) {
            } else {
                break 'l0;
            }
            {
                let _e51 = k_v5;
                let v_e52 = ((row_e3).vertices)[_e51 as usize];
                let displacement_e55 = <[f32; 4]>::load(m.displacements, 4 * (v_e52 as usize));
                let _e58 = <[i32; 4]>::load(m.positions, 4 * (v_e52 as usize));
                let mut place_v6: [f32; 3];
                place_v6 = zip(swizzle(_e58, [0, 1, 2]), origin_e40, |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                let _e63 = place_v6;
                let reach_e67 = zip(_e63.map(|x| x.abs()), swizzle(displacement_e55, [0, 1, 2]).map(|x| x.abs()), |x, y| x.max(y));
                let _e68 = longest_v4;
                longest_v4 = _e68.max((reach_e67)[0].max((reach_e67)[1]).max((reach_e67)[2]));
                if ((displacement_e55)[3] == 0.0f32) {
                    let _e78 = place_v6;
                    place_v6 = zip(_e78, swizzle(displacement_e55, [0, 1, 2]), |x, y| (x + y));
                }
                let _e81 = k_v5;
                let _e83 = place_v6;
                let _e84 = (displacement_e55)[3];
                places_v1[_e81 as usize] = [(_e83)[0], (_e83)[1], (_e83)[2], _e84];
                let _e86 = k_v5;
                let _e89 = k_v5;
                weights_v2[_e86 as usize] = ((row_e3).weights)[_e89 as usize];
                let _e91 = k_v5;
                let _e95 = means_v3[u32::from((_e91 >= side_a_e29)) as usize];
                let _e96 = place_v6;
                let _e98 = k_v5;
                means_v3[u32::from((_e91 >= side_a_e29)) as usize] = zip(_e95, _e96.map(|x| (x * ((row_e3).weights)[_e98 as usize].abs())), |x, y| (x + y));
            }
        }
        let _e103 = k_v5;
        k_v5 = _e103.wrapping_add(1u32);
    }
    let _e108 = longest_v4;
    let rounding_e110 = (4.0f32 + (9.536743e-7f32 * _e108));
    let _e113 = means_v3[1];
    let of_a_e115 = lacking_of(0u32, side_a_e29, _e113, (row_e3).normal, wanted_e34, rounding_e110, &mut places_v1, &mut weights_v2);
    let _e117 = means_v3[0];
    let of_b_e120 = lacking_of(side_a_e29, count_e24, _e117, (row_e3).normal.map(|x| (-x)), wanted_e34, rounding_e110, &mut places_v1, &mut weights_v2);
    Stored::store(((row_e3).value + (of_a_e115 + of_b_e120)), m.rows, 24 * (r_a0 as usize) + 11);
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 14);
    let _e6 = m.params.capacity;
    let count_e7 = _e3.min(_e6);
    let mut r_v0: u32;
    r_v0 = ([128 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = r_v0;
            if (_e10 < count_e7) {
            } else {
                break 'l0;
            }
            {
                let _e12 = r_v0;
                lower_target(m, _e12);
            }
        }
        let _e13 = r_v0;
        r_v0 = _e13.wrapping_add(8388480u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let displacements = bound.read(1);
    let candidates = bound.read(2);
    let separations = bound.read(3);
    let mut rows = bound.write(4);
    let mut control = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        displacements: &displacements,
        candidates: &candidates,
        separations: &separations,
        rows: &mut rows,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..128 {
            main(&mut m, group as u32, t);
        }
    }
}
}
