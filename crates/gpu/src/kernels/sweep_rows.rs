// Written from `shader/backward/sweep_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "sweep_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/sweep_rows.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Write],
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
pub const SLOTS: u32 = 512u32;
pub const EMPTY: u32 = 4294967295u32;

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
use crate::kernels::sweep_rows::*;
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
pub struct Bucket {
    pub first: u32,
    pub end: u32,
    pub colors: u32,
    pub most: u32,
}

impl Bucket {
    const ZERO: Self = Self {
        first: 0u32,
        end: 0u32,
        colors: 0u32,
        most: 0u32,
    };
}

impl Stored for Bucket {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            first: <u32>::load(words, at + 0),
            end: <u32>::load(words, at + 1),
            colors: <u32>::load(words, at + 2),
            most: <u32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.first.store(words, at + 0);
        self.end.store(words, at + 1);
        self.colors.store(words, at + 2);
        self.most.store(words, at + 3);
    }
}

struct Memory<'a> {
    params: Params,
    order: &'a [u32],
    buckets: &'a [u32],
    color_ends: &'a [u32],
    rows: &'a mut [u32],
    displacements: &'a mut [u32],
    pushes: &'a mut [u32],
    keys: [u32; 512],
    moved: [[f32; 4]; 512],
    overflow: u32,
    is_full: u32,
    changes: u32,
    is_changing: u32,
    largest: u32,
    largest_of_all: u32,
}

#[derive(Clone, Copy)]
struct Private {
    row: Row,
    is_kept: bool,
}

pub fn displacement(m: &mut Memory<'_>, p: &mut Private, v_a0: u32) -> [f32; 4] {
    let _e2 = p.is_kept;
    if _e2 {
        let _e5 = m.moved[v_a0 as usize];
        return _e5;
    }
    let _e8 = <[f32; 4]>::load(m.displacements, 4 * (v_a0 as usize));
    return _e8;
}

pub fn relative_displacement(m: &mut Memory<'_>, p: &mut Private) -> [f32; 3] {
    let mut sum_v0: [f32; 3] = [0.0f32; 3];
    let mut k_v1: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e5 = k_v1;
            if (_e5 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e8 = sum_v0;
                let _e11 = k_v1;
                let _e13 = p.row.weights[_e11 as usize];
                let _e16 = k_v1;
                let _e18 = p.row.vertices[_e16 as usize];
                let _e19 = displacement(m, p, _e18);
                sum_v0 = zip(_e8, swizzle(_e19, [0, 1, 2]).map(|x| (_e13 * x)), |x, y| (x + y));
            }
        }
        let _e23 = k_v1;
        k_v1 = _e23.wrapping_add(1u32);
    }
    let _e26 = sum_v0;
    return _e26;
}

pub fn push(m: &mut Memory<'_>, p: &mut Private, change_a0: [f32; 3]) {
    let mut k_v0: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e3 = k_v0;
            if (_e3 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e8 = k_v0;
                let v_e10 = p.row.vertices[_e8 as usize];
                let old_e11 = displacement(m, p, v_e10);
                let _e15 = k_v0;
                let _e17 = p.row.weights[_e15 as usize];
                let step_e18 = ((old_e11)[3] * _e17);
                if (step_e18 != 0.0f32) {
                    let _e23 = zip(swizzle(old_e11, [0, 1, 2]), change_a0.map(|x| (x * step_e18)), |x, y| (x + y));
                    let _e24 = (old_e11)[3];
                    let pushed_e25 = [(_e23)[0], (_e23)[1], (_e23)[2], _e24];
                    let _e27 = p.is_kept;
                    if _e27 {
                        m.moved[v_e10 as usize] = pushed_e25;
                    } else {
                        Stored::store(pushed_e25, m.displacements, 4 * (v_e10 as usize));
                    }
                }
            }
        }
        let _e32 = k_v0;
        k_v0 = _e32.wrapping_add(1u32);
    }
}

pub fn pressed(m: &mut Memory<'_>, p: &mut Private) -> f32 {
    let _e2 = p.row.value;
    let _e5 = p.row.normal;
    let _e6 = relative_displacement(m, p);
    let value_e8 = (_e2 + dot(_e5, _e6));
    let _e11 = p.row.multiplier;
    let _e14 = p.row.inverse_diagonal;
    return (_e11 - (value_e8 * _e14)).max(0.0f32);
}

pub fn rubbed(m: &mut Memory<'_>, p: &mut Private, multiplier_a0: f32) -> [f32; 3] {
    let _e3 = p.row.coefficient;
    let mut local_v0: bool;
    if (!(_e3 <= 0.0f32)) {
        let mut local_v1: bool;
        if (multiplier_a0 <= 0.0f32) {
            let _e15 = p.row.friction;
            local_v1 = all(zip(_e15, [0.0f32; 3], |x, y| (x == y)));
        } else {
            local_v1 = false;
        }
        let _e21 = local_v1;
        local_v0 = _e21;
    } else {
        local_v0 = true;
    }
    let _e23 = local_v0;
    if _e23 {
        let _e26 = p.row.friction;
        return _e26;
    }
    let _e29 = p.row.slip;
    let _e30 = relative_displacement(m, p);
    let slipped_e31 = zip(_e29, _e30, |x, y| (x + y));
    let _e34 = p.row.normal;
    let _e37 = p.row.normal;
    let slip_e40 = zip(slipped_e31, _e34.map(|x| (x * dot(_e37, slipped_e31))), |x, y| (x - y));
    let _e43 = p.row.friction;
    let _e46 = p.row.inverse_diagonal;
    let wanted_e48 = zip(_e43, slip_e40.map(|x| (x * _e46)), |x, y| (x - y));
    let size_e50 = dot(wanted_e48, wanted_e48).sqrt();
    let _e53 = p.row.coefficient;
    let largest_e54 = (_e53 * multiplier_a0);
    if (size_e50 > largest_e54) {
        return wanted_e48.map(|x| (x * (largest_e54 / size_e50)));
    }
    return wanted_e48;
}

pub fn would_change(m: &mut Memory<'_>, p: &mut Private) -> bool {
    let _e2 = p.row.inverse_diagonal;
    if (_e2 == 0.0f32) {
        return false;
    }
    let _e8 = m.params.only_apply;
    if (_e8 != 0u32) {
        let _e13 = p.row.multiplier;
        let mut local_v0: bool;
        if (!(_e13 != 0.0f32)) {
            let _e21 = p.row.friction;
            local_v0 = any(zip(_e21, [0.0f32; 3], |x, y| (x != y)));
        } else {
            local_v0 = true;
        }
        let _e27 = local_v0;
        return _e27;
    }
    let multiplier_e28 = pressed(m, p);
    let _e31 = p.row.multiplier;
    let mut local_v1: bool;
    if (!(multiplier_e28 != _e31)) {
        let _e36 = rubbed(m, p, multiplier_e28);
        let _e39 = p.row.friction;
        local_v1 = any(zip(_e36, _e39, |x, y| (x != y)));
    } else {
        local_v1 = true;
    }
    let _e43 = local_v1;
    return _e43;
}

pub fn relax(m: &mut Memory<'_>, p: &mut Private) {
    let _e2 = p.row.inverse_diagonal;
    if (_e2 == 0.0f32) {
        return;
    }
    let _e7 = m.params.only_apply;
    if (_e7 != 0u32) {
        let _e12 = p.row.normal;
        let _e15 = p.row.multiplier;
        let _e19 = p.row.friction;
        push(m, p, zip(_e12.map(|x| (x * _e15)), _e19, |x, y| (x + y)));
        return;
    }
    let multiplier_e21 = pressed(m, p);
    let _e24 = p.row.normal;
    let _e27 = p.row.multiplier;
    push(m, p, _e24.map(|x| (x * (multiplier_e21 - _e27))));
    p.row.multiplier = multiplier_e21;
    let friction_e32 = rubbed(m, p, multiplier_e21);
    let _e35 = p.row.friction;
    if any(zip(friction_e32, _e35, |x, y| (x != y))) {
        let _e40 = p.row.friction;
        push(m, p, zip(friction_e32, _e40, |x, y| (x - y)));
        p.row.friction = friction_e32;
    }
}

pub fn store(m: &mut Memory<'_>, p: &mut Private, r_a0: u32) {
    let _e3 = m.params.only_apply;
    if (_e3 == 0u32) {
        let _e11 = p.row.multiplier;
        Stored::store(_e11, m.rows, 24 * (r_a0 as usize) + 13);
        let _e17 = p.row.friction;
        Stored::store(_e17, m.rows, 24 * (r_a0 as usize) + 20);
    }
}

pub fn relax_there(m: &mut Memory<'_>, p: &mut Private, r_a0: u32) {
    let _e4 = <Row>::load(m.rows, 24 * (r_a0 as usize));
    p.row = _e4;
    relax(m, p);
    store(m, p, r_a0);
}

pub fn relax_alone(m: &mut Memory<'_>, p: &mut Private) -> [f32; 3] {
    let _e2 = p.row.inverse_diagonal;
    if (_e2 == 0.0f32) {
        return [0.0f32; 3];
    }
    let _e9 = m.params.only_apply;
    if (_e9 != 0u32) {
        let _e14 = p.row.normal;
        let _e17 = p.row.multiplier;
        let _e21 = p.row.friction;
        return zip(_e14.map(|x| (x * _e17)), _e21, |x, y| (x + y));
    }
    let multiplier_e23 = pressed(m, p);
    let friction_e24 = rubbed(m, p, multiplier_e23);
    let _e27 = p.row.normal;
    let _e30 = p.row.multiplier;
    let _e35 = p.row.friction;
    let change_e37 = zip(_e27.map(|x| (x * (multiplier_e23 - _e30))), zip(friction_e24, _e35, |x, y| (x - y)), |x, y| (x + y));
    p.row.multiplier = multiplier_e23;
    p.row.friction = friction_e24;
    return change_e37;
}

pub fn relax_together(m: &mut Memory<'_>, p: &mut [Private; 256], first_a0: [u32; 256], bucket_a1: [Bucket; 256], thread_a2: [u32; 256]) {
    let mut own_v0: [f32; 256] = [0.0f32; 256];
    let mut bits_e74: [u32; 256] = [0u32; 256];
    let mut _e83: [bool; 256] = [false; 256];
    let mut unit_e94: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        if (thread_a2[t] == 0u32) {
            m.largest = 0u32;
        }
    }
    for t in 0..256 {
        let mut there_v1: u32;
        there_v1 = first_a0[t].wrapping_add(thread_a2[t]);
        'l0: loop {
            'c0: {
                let _e11 = there_v1;
                if (_e11 < (bucket_a1[t]).end) {
                } else {
                    break 'l0;
                }
                {
                    let _e17 = there_v1;
                    let _e19 = <u32>::load(m.order, 1 * (_e17 as usize));
                    let _e21 = <Row>::load(m.rows, 24 * (_e19 as usize));
                    p[t].row = _e21;
                    let _e22 = relax_alone(m, &mut p[t]);
                    let change_e23 = _e22.map(|x| x.abs());
                    let mut k_v2: u32;
                    k_v2 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e26 = k_v2;
                            if (_e26 < 4u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e32 = k_v2;
                                let _e34 = p[t].row.vertices[_e32 as usize];
                                let _e37 = <f32>::load(m.displacements, 4 * (_e34 as usize) + 3);
                                let _e40 = k_v2;
                                let _e42 = p[t].row.weights[_e40 as usize];
                                let share_e44 = (_e37 * _e42).abs();
                                let _e45 = own_v0[t];
                                own_v0[t] = _e45.max((share_e44 * (change_e23)[0].max((change_e23)[1].max((change_e23)[2]))));
                            }
                        }
                        let _e53 = k_v2;
                        k_v2 = _e53.wrapping_add(1u32);
                    }
                }
            }
            let _e56 = there_v1;
            there_v1 = _e56.wrapping_add(256u32);
        }
        let _e60 = own_v0[t];
        { let old = m.largest; let new = old.max(_e60.to_bits()); m.largest = new; old };
    }
    for t in 0..256 {
        if (thread_a2[t] == 0u32) {
            let _e67 = m.largest;
            m.largest_of_all = _e67;
        }
    }
    let _e69 = { let t = 0; m.largest_of_all };
    for t in 0..256 {
        bits_e74[t] = (f32::from_bits(_e69 as u32) * ((bucket_a1[t]).most as f32)).to_bits();
        let mut local_v3: bool;
        if (!(bits_e74[t] == 0u32)) {
            local_v3 = (bits_e74[t] >= 2130706432u32);
        } else {
            local_v3 = true;
        }
        _e83[t] = local_v3;
    }
    if uniform(std::array::from_fn::<_, 256, _>(|t| _e83[t])) {
        return;
    }
    for t in 0..256 {
        let exponent_e91 = bits_e74[t].wrapping_shr(23u32).wrapping_add(1u32).max(31u32).wrapping_sub(30u32);
        unit_e94[t] = f32::from_bits(exponent_e91.wrapping_shl(23u32) as u32);
        let inverse_e99 = f32::from_bits(254u32.wrapping_sub(exponent_e91).wrapping_shl(23u32) as u32);
        let mut there_v4: u32;
        there_v4 = first_a0[t].wrapping_add(thread_a2[t]);
        'l2: loop {
            'c2: {
                let _e102 = there_v4;
                if (_e102 < (bucket_a1[t]).end) {
                } else {
                    break 'l2;
                }
                {
                    let _e106 = there_v4;
                    let r_e108 = <u32>::load(m.order, 1 * (_e106 as usize));
                    let _e112 = <Row>::load(m.rows, 24 * (r_e108 as usize));
                    p[t].row = _e112;
                    let _e113 = relax_alone(m, &mut p[t]);
                    let change_e114 = _e113.map(|x| (x * inverse_e99));
                    let mut k_v5: u32;
                    k_v5 = 0u32;
                    'l3: loop {
                        'c3: {
                            let _e117 = k_v5;
                            if (_e117 < 4u32) {
                            } else {
                                break 'l3;
                            }
                            {
                                let _e122 = k_v5;
                                let v_e124 = p[t].row.vertices[_e122 as usize];
                                let _e128 = <f32>::load(m.displacements, 4 * (v_e124 as usize) + 3);
                                let _e131 = k_v5;
                                let _e133 = p[t].row.weights[_e131 as usize];
                                let share_e134 = (_e128 * _e133);
                                if (share_e134 != 0.0f32) {
                                    let push_e139 = change_e114.map(|x| (share_e134 * x)).map(|x| x.round_ties_even()).map(|x| (x as i32));
                                    let mut c_v6: u32;
                                    c_v6 = 0u32;
                                    'l4: loop {
                                        'c4: {
                                            let _e142 = c_v6;
                                            if (_e142 < 3u32) {
                                            } else {
                                                break 'l4;
                                            }
                                            {
                                                let _e148 = c_v6;
                                                let _e151 = c_v6;
                                                { let old = <i32>::load(m.pushes, 1 * (4u32.wrapping_mul(v_e124).wrapping_add(_e148) as usize)); let new = old.wrapping_add((push_e139)[_e151 as usize]); Stored::store(new, m.pushes, 1 * (4u32.wrapping_mul(v_e124).wrapping_add(_e148) as usize)); old };
                                            }
                                        }
                                        let _e154 = c_v6;
                                        c_v6 = _e154.wrapping_add(1u32);
                                    }
                                    Stored::store(1i32, m.pushes, 1 * (4u32.wrapping_mul(v_e124).wrapping_add(3u32) as usize));
                                }
                            }
                        }
                        let _e164 = k_v5;
                        k_v5 = _e164.wrapping_add(1u32);
                    }
                    store(m, &mut p[t], r_e108);
                }
            }
            let _e167 = there_v4;
            there_v4 = _e167.wrapping_add(256u32);
        }
    }
    for t in 0..256 {
        let mut there_v7: u32;
        there_v7 = first_a0[t].wrapping_add(thread_a2[t]);
        'l5: loop {
            'c5: {
                let _e172 = there_v7;
                if (_e172 < (bucket_a1[t]).end) {
                } else {
                    break 'l5;
                }
                {
                    let _e177 = there_v7;
                    let _e179 = <u32>::load(m.order, 1 * (_e177 as usize));
                    let vertices_e182 = <[u32; 4]>::load(m.rows, 24 * (_e179 as usize));
                    let mut k_v8: u32;
                    k_v8 = 0u32;
                    'l6: loop {
                        'c6: {
                            let _e185 = k_v8;
                            if (_e185 < 4u32) {
                            } else {
                                break 'l6;
                            }
                            {
                                let _e188 = k_v8;
                                let v_e189 = (vertices_e182)[_e188 as usize];
                                let _e197 = { let old = <i32>::load(m.pushes, 1 * (4u32.wrapping_mul(v_e189).wrapping_add(3u32) as usize)); let new = 0i32; Stored::store(new, m.pushes, 1 * (4u32.wrapping_mul(v_e189).wrapping_add(3u32) as usize)); old };
                                if (_e197 != 0i32) {
                                    let mut push_v9: [f32; 3];
                                    push_v9 = [0.0f32; 3];
                                    let mut c_v10: u32;
                                    c_v10 = 0u32;
                                    'l7: loop {
                                        'c7: {
                                            let _e205 = c_v10;
                                            if (_e205 < 3u32) {
                                            } else {
                                                break 'l7;
                                            }
                                            {
                                                let _e208 = c_v10;
                                                let _e213 = c_v10;
                                                let _e217 = { let old = <i32>::load(m.pushes, 1 * (4u32.wrapping_mul(v_e189).wrapping_add(_e213) as usize)); let new = 0i32; Stored::store(new, m.pushes, 1 * (4u32.wrapping_mul(v_e189).wrapping_add(_e213) as usize)); old };
                                                push_v9[_e208 as usize] = (_e217 as f32);
                                            }
                                        }
                                        let _e219 = c_v10;
                                        c_v10 = _e219.wrapping_add(1u32);
                                    }
                                    let _e226 = <[f32; 4]>::load(m.displacements, 4 * (v_e189 as usize));
                                    let _e228 = push_v9;
                                    let _e230 = zip(swizzle(_e226, [0, 1, 2]), _e228.map(|x| (x * unit_e94[t])), |x, y| (x + y));
                                    let _e234 = <f32>::load(m.displacements, 4 * (v_e189 as usize) + 3);
                                    Stored::store([(_e230)[0], (_e230)[1], (_e230)[2], _e234], m.displacements, 4 * (v_e189 as usize));
                                }
                            }
                        }
                        let _e236 = k_v8;
                        k_v8 = _e236.wrapping_add(1u32);
                    }
                }
            }
            let _e239 = there_v7;
            there_v7 = _e239.wrapping_add(256u32);
        }
    }
}

pub fn slot_of(m: &mut Memory<'_>, v_a0: u32) -> u32 {
    let mut tries_v1: u32 = 0u32;
    let mut slot_v0: u32;
    slot_v0 = v_a0.wrapping_mul(2654435761u32).wrapping_shr(23u32);
    'l0: loop {
        'c0: {
            let _e8 = tries_v1;
            if (_e8 < 512u32) {
            } else {
                break 'l0;
            }
            {
                let _e12 = slot_v0;
                let found_e15 = { let old = m.keys[_e12 as usize]; let exchanged = old == 4294967295u32; let new = if exchanged { v_a0 } else { old }; m.keys[_e12 as usize] = new; Exchanged { old_value: old, exchanged } };
                let mut local_v2: bool;
                if (!(found_e15).exchanged) {
                    local_v2 = ((found_e15).old_value == v_a0);
                } else {
                    local_v2 = true;
                }
                let _e23 = local_v2;
                if _e23 {
                    let _e24 = slot_v0;
                    return _e24;
                }
                if ((found_e15).old_value != 4294967295u32) {
                    let _e28 = slot_v0;
                    slot_v0 = (_e28.wrapping_add(1u32) % 512u32);
                    let _e33 = tries_v1;
                    tries_v1 = _e33.wrapping_add(1u32);
                }
            }
        }
    }
    return 512u32;
}

pub fn main(m: &mut Memory<'_>, p: &mut [Private; 256], group: u32) {
    let mut k_v0: u32 = 0u32;
    let mut colored_end_v1: [u32; 256] = [0u32; 256];
    let mut r_v4: [u32; 256] = [0u32; 256];
    let mut sweep_v12: u32 = 0u32;
    let mut start_v13: [u32; 256] = [0u32; 256];
    let mut color_v14: u32 = 0u32;
    let mut bucket_e16: [Bucket; 256] = [Bucket::ZERO; 256];
    let mut place_e22: [u32; 256] = [0u32; 256];
    let mut has_row_e24: [bool; 256] = [false; 256];
    let mut _e233: [u32; 256] = [0u32; 256];
    let mut _e236: [u32; 256] = [0u32; 256];
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
                    bucket_e16[t] = <Bucket>::load(m.buckets, 4 * (_e14 as usize));
                }
                if uniform(std::array::from_fn::<_, 256, _>(|t| ((bucket_e16[t]).first == (bucket_e16[t]).end))) {
                    break 'c0;
                }
                for t in 0..256 {
                    place_e22[t] = (bucket_e16[t]).first.wrapping_add(([t as u32, 0, 0])[0]);
                    has_row_e24[t] = (place_e22[t] < (bucket_e16[t]).end);
                    colored_end_v1[t] = (bucket_e16[t]).first;
                    if ((bucket_e16[t]).colors > 0u32) {
                        let _e37 = <u32>::load(m.color_ends, 1 * ((bucket_e16[t]).first.wrapping_add((bucket_e16[t]).colors).wrapping_sub(1u32) as usize));
                        colored_end_v1[t] = _e37;
                    }
                    let mut local_v2: bool;
                    if ((bucket_e16[t]).end.wrapping_sub((bucket_e16[t]).first) <= 256u32) {
                        let _e46 = colored_end_v1[t];
                        local_v2 = (_e46 == (bucket_e16[t]).end);
                    } else {
                        local_v2 = false;
                    }
                    let _e50 = local_v2;
                    p[t].is_kept = _e50;
                    let mut s_v3: u32;
                    s_v3 = ([t as u32, 0, 0])[0];
                    'l1: loop {
                        'c1: {
                            let _e53 = s_v3;
                            if (_e53 < 512u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e57 = s_v3;
                                m.keys[_e57 as usize] = 4294967295u32;
                            }
                        }
                        let _e60 = s_v3;
                        s_v3 = _e60.wrapping_add(256u32);
                    }
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        m.overflow = 0u32;
                        m.changes = 0u32;
                    }
                }
                for t in 0..256 {
                    r_v4[t] = 0u32;
                    let _e73 = p[t].is_kept;
                    let mut local_v5: bool;
                    if _e73 {
                        local_v5 = has_row_e24[t];
                    } else {
                        local_v5 = false;
                    }
                    let _e77 = local_v5;
                    if _e77 {
                        let _e80 = <u32>::load(m.order, 1 * (place_e22[t] as usize));
                        r_v4[t] = _e80;
                        let _e83 = r_v4[t];
                        let _e85 = <Row>::load(m.rows, 24 * (_e83 as usize));
                        p[t].row = _e85;
                        let mut c_v6: u32;
                        c_v6 = 0u32;
                        'l2: loop {
                            'c2: {
                                let _e88 = c_v6;
                                if (_e88 < 4u32) {
                                } else {
                                    break 'l2;
                                }
                                {
                                    let _e93 = c_v6;
                                    let _e95 = p[t].row.vertices[_e93 as usize];
                                    let slot_e96 = slot_of(m, _e95);
                                    if (slot_e96 == 512u32) {
                                        m.overflow = 1u32;
                                    }
                                    let _e103 = c_v6;
                                    p[t].row.vertices[_e103 as usize] = slot_e96;
                                }
                            }
                            let _e105 = c_v6;
                            c_v6 = _e105.wrapping_add(1u32);
                        }
                    }
                }
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        let _e113 = m.overflow;
                        m.is_full = _e113;
                    }
                }
                let _e115 = { let t = 0; m.is_full };
                for t in 0..256 {
                    if (_e115 != 0u32) {
                        p[t].is_kept = false;
                    }
                    let _e121 = p[t].is_kept;
                    if _e121 {
                        let mut s_v7: u32;
                        s_v7 = ([t as u32, 0, 0])[0];
                        'l3: loop {
                            'c3: {
                                let _e124 = s_v7;
                                if (_e124 < 512u32) {
                                } else {
                                    break 'l3;
                                }
                                {
                                    let _e128 = s_v7;
                                    let v_e130 = m.keys[_e128 as usize];
                                    if (v_e130 != 4294967295u32) {
                                        let _e134 = s_v7;
                                        let _e138 = <[f32; 4]>::load(m.displacements, 4 * (v_e130 as usize));
                                        m.moved[_e134 as usize] = _e138;
                                    }
                                }
                            }
                            let _e139 = s_v7;
                            s_v7 = _e139.wrapping_add(256u32);
                        }
                    }
                }
                for t in 0..256 {
                    let mut any_changes_v8: bool;
                    any_changes_v8 = false;
                    let _e145 = p[t].is_kept;
                    if _e145 {
                        let mut local_v9: bool;
                        if has_row_e24[t] {
                            let _e148 = would_change(m, &mut p[t]);
                            local_v9 = _e148;
                        } else {
                            local_v9 = false;
                        }
                        let _e150 = local_v9;
                        any_changes_v8 = _e150;
                    } else {
                        let mut there_v10: u32;
                        there_v10 = place_e22[t];
                        'l4: loop {
                            'c4: {
                                let _e152 = there_v10;
                                let mut local_v11: bool;
                                if (_e152 < (bucket_e16[t]).end) {
                                    let _e157 = any_changes_v8;
                                    local_v11 = (!_e157);
                                } else {
                                    local_v11 = false;
                                }
                                let _e160 = local_v11;
                                if _e160 {
                                } else {
                                    break 'l4;
                                }
                                {
                                    let _e164 = there_v10;
                                    let _e166 = <u32>::load(m.order, 1 * (_e164 as usize));
                                    let _e168 = <Row>::load(m.rows, 24 * (_e166 as usize));
                                    p[t].row = _e168;
                                    let _e169 = would_change(m, &mut p[t]);
                                    any_changes_v8 = _e169;
                                }
                            }
                            let _e170 = there_v10;
                            there_v10 = _e170.wrapping_add(256u32);
                        }
                    }
                    let _e173 = any_changes_v8;
                    if _e173 {
                        m.changes = 1u32;
                    }
                }
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        let _e181 = m.changes;
                        m.is_changing = _e181;
                    }
                }
                let _e183 = { let t = 0; m.is_changing };
                if (_e183 == 0u32) {
                    break 'c0;
                }
                sweep_v12 = 0u32;
                'l5: loop {
                    'c5: {
                        let _e188 = sweep_v12;
                        let _e191 = m.params.sweeps;
                        if (_e188 < _e191) {
                        } else {
                            break 'l5;
                        }
                        {
                            for t in 0..256 {
                                start_v13[t] = (bucket_e16[t]).first;
                            }
                            color_v14 = 0u32;
                            'l6: loop {
                                'c6: {
                                    let _e197 = color_v14;
                                    if uniform(std::array::from_fn::<_, 256, _>(|t| (_e197 < (bucket_e16[t]).colors))) {
                                    } else {
                                        break 'l6;
                                    }
                                    {
                                        for t in 0..256 {
                                            let _e201 = p[t].is_kept;
                                            if _e201 {
                                                let mut local_v15: bool;
                                                if has_row_e24[t] {
                                                    let _e206 = p[t].row.color;
                                                    let _e207 = color_v14;
                                                    local_v15 = (_e206 == _e207);
                                                } else {
                                                    local_v15 = false;
                                                }
                                                let _e210 = local_v15;
                                                if _e210 {
                                                    relax(m, &mut p[t]);
                                                }
                                            } else {
                                                let _e213 = color_v14;
                                                let end_e216 = <u32>::load(m.color_ends, 1 * ((bucket_e16[t]).first.wrapping_add(_e213) as usize));
                                                let _e217 = start_v13[t];
                                                let mut there_v16: u32;
                                                there_v16 = _e217.wrapping_add(([t as u32, 0, 0])[0]);
                                                'l7: loop {
                                                    'c7: {
                                                        let _e221 = there_v16;
                                                        if (_e221 < end_e216) {
                                                        } else {
                                                            break 'l7;
                                                        }
                                                        {
                                                            let _e224 = there_v16;
                                                            let _e226 = <u32>::load(m.order, 1 * (_e224 as usize));
                                                            relax_there(m, &mut p[t], _e226);
                                                        }
                                                    }
                                                    let _e227 = there_v16;
                                                    there_v16 = _e227.wrapping_add(256u32);
                                                }
                                                start_v13[t] = end_e216;
                                            }
                                        }
                                    }
                                }
                                let _e230 = color_v14;
                                color_v14 = _e230.wrapping_add(1u32);
                            }
                            for t in 0..256 {
                                _e233[t] = colored_end_v1[t];
                            }
                            if uniform(std::array::from_fn::<_, 256, _>(|t| (_e233[t] < (bucket_e16[t]).end))) {
                                for t in 0..256 {
                                    _e236[t] = colored_end_v1[t];
                                }
                                relax_together(m, p, std::array::from_fn::<_, 256, _>(|t| _e236[t]), std::array::from_fn::<_, 256, _>(|t| bucket_e16[t]), std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]));
                            }
                        }
                    }
                    let _e238 = sweep_v12;
                    sweep_v12 = _e238.wrapping_add(1u32);
                }
                for t in 0..256 {
                    let _e242 = p[t].is_kept;
                    if _e242 {
                        let mut s_v17: u32;
                        s_v17 = ([t as u32, 0, 0])[0];
                        'l8: loop {
                            'c8: {
                                let _e245 = s_v17;
                                if (_e245 < 512u32) {
                                } else {
                                    break 'l8;
                                }
                                {
                                    let _e249 = s_v17;
                                    let v_e251 = m.keys[_e249 as usize];
                                    let mut local_v18: bool;
                                    if (v_e251 != 4294967295u32) {
                                        let _e257 = s_v17;
                                        let _e260 = m.moved[_e257 as usize][3];
                                        local_v18 = (_e260 > 0.0f32);
                                    } else {
                                        local_v18 = false;
                                    }
                                    let _e264 = local_v18;
                                    if _e264 {
                                        let _e268 = s_v17;
                                        let _e270 = m.moved[_e268 as usize];
                                        Stored::store(_e270, m.displacements, 4 * (v_e251 as usize));
                                    }
                                }
                            }
                            let _e271 = s_v17;
                            s_v17 = _e271.wrapping_add(256u32);
                        }
                        if has_row_e24[t] {
                            let _e274 = r_v4[t];
                            store(m, &mut p[t], _e274);
                        }
                    }
                }
            }
        }
        let _e275 = k_v0;
        k_v0 = _e275.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let order = bound.read(0);
    let buckets = bound.read(1);
    let color_ends = bound.read(2);
    let mut rows = bound.write(3);
    let mut displacements = bound.write(4);
    let mut pushes = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        order: &order,
        buckets: &buckets,
        color_ends: &color_ends,
        rows: &mut rows,
        displacements: &mut displacements,
        pushes: &mut pushes,
        keys: [0u32; 512],
        moved: [[0.0f32; 4]; 512],
        overflow: 0u32,
        is_full: 0u32,
        changes: 0u32,
        is_changing: 0u32,
        largest: 0u32,
        largest_of_all: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.keys = [0u32; 512];
        m.moved = [[0.0f32; 4]; 512];
        m.overflow = 0u32;
        m.is_full = 0u32;
        m.changes = 0u32;
        m.is_changing = 0u32;
        m.largest = 0u32;
        m.largest_of_all = 0u32;
        let mut p = [Private { row: Row::ZERO, is_kept: false, }; 256];
        main(&mut m, &mut p, group as u32);
    }
}
}
