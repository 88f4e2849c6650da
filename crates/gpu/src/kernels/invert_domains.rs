// Written from `shader/preconditioner/invert_domains.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "invert_domains",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/groups.wgsl"),
        include_str!("../../shader/preconditioner/invert_domains.wgsl"),
    ],
    workgroup: 192,
    bindings: &[Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const SHIFT: f32 = 4e-6f32;
pub const ZERO_PIVOT: f32 = 1e-6f32;
pub const WIDE: u32 = 192u32;
pub const ROW: u32 = 49u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub domains: u32,
    pub first: u32,
    pub first_inverse: u32,
    pub first_part: u32,
    pub parts: u32,
    pub springs: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::invert_domains::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    tables: &'a [u32],
    couplings: &'a [u32],
    touching: &'a [u32],
    pressed: &'a [u32],
    frames: &'a [u32],
    inverses: &'a mut [u32],
    matrix: [f32; 2352],
    pivot_row: [f32; 48],
    pivot_column: [f32; 48],
    diagonal: [f32; 48],
}

pub fn entry(m: &mut Memory<'_>, d_a0: u32, r_a1: u32, k_a2: u32) -> f32 {
    let mut value_v0: f32 = 0.0f32;
    let block_e15 = <u32>::load(m.tables, 1 * (64u32.wrapping_mul(d_a0).wrapping_add(8u32.wrapping_mul((r_a1 / 6u32))).wrapping_add((k_a2 / 6u32)) as usize));
    if (block_e15 != 4294967295u32) {
        let _e32 = <f32>::load(m.couplings, 1 * (36u32.wrapping_mul(block_e15).wrapping_add(6u32.wrapping_mul((r_a1 % 6u32))).wrapping_add((k_a2 % 6u32)) as usize));
        value_v0 = _e32;
    }
    let _e35 = m.params.springs;
    if (_e35 == 1u32) {
        let end_e42 = <u32>::load(m.touching, 1 * (d_a0.wrapping_add(1u32) as usize));
        let _e45 = <u32>::load(m.touching, 1 * (d_a0 as usize));
        let mut c_v1: u32;
        c_v1 = _e45;
        'l0: loop {
            'c0: {
                let _e47 = c_v1;
                if (_e47 < end_e42) {
                } else {
                    break 'l0;
                }
                {
                    let _e49 = value_v0;
                    let _e52 = c_v1;
                    let _e59 = <f32>::load(m.pressed, 1 * (2304u32.wrapping_mul(_e52).wrapping_add(48u32.wrapping_mul(r_a1)).wrapping_add(k_a2) as usize));
                    value_v0 = (_e49 + _e59);
                }
            }
            let _e61 = c_v1;
            c_v1 = _e61.wrapping_add(1u32);
        }
    }
    let _e64 = value_v0;
    return _e64;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut d_v0: u32 = 0u32;
    let mut k_v8: u32 = 0u32;
    let mut t_e2: [u32; 192] = [0u32; 192];
    let mut row_e4: [u32; 192] = [0u32; 192];
    let mut lane_e6: [u32; 192] = [0u32; 192];
    for t in 0..192 {
        t_e2[t] = ([t as u32, 0, 0])[0];
        row_e4[t] = (t_e2[t] / 4u32);
        lane_e6[t] = (t_e2[t] % 4u32);
    }
    d_v0 = ([group, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e9 = d_v0;
            let _e12 = m.params.domains;
            if (_e9 < _e12) {
            } else {
                break 'l0;
            }
            {
                for t in 0..192 {
                    let mut k_v1: u32;
                    k_v1 = t_e2[t];
                    'l1: loop {
                        'c1: {
                            let _e15 = k_v1;
                            if (_e15 < 2304u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e18 = k_v1;
                                let r_e20 = (_e18 / 48u32);
                                let _e21 = k_v1;
                                let c_e23 = (_e21 % 48u32);
                                let _e31 = m.params.first;
                                let _e32 = d_v0;
                                let _e36 = entry(m, _e31.wrapping_add(_e32), r_e20.min(c_e23), r_e20.max(c_e23));
                                m.matrix[49u32.wrapping_mul(r_e20).wrapping_add(c_e23) as usize] = _e36;
                            }
                        }
                        let _e37 = k_v1;
                        k_v1 = _e37.wrapping_add(192u32);
                    }
                }
                for t in 0..192 {
                    let mut local_v2: bool;
                    if (t_e2[t] < 8u32) {
                        let _e45 = d_v0;
                        let _e50 = m.params.parts;
                        local_v2 = (8u32.wrapping_mul(_e45).wrapping_add(t_e2[t]) < _e50);
                    } else {
                        local_v2 = false;
                    }
                    let _e53 = local_v2;
                    if _e53 {
                        let mut stiffness_v3: f32;
                        stiffness_v3 = 0.0f32;
                        let mut k_v4: u32;
                        k_v4 = 0u32;
                        'l2: loop {
                            'c2: {
                                let _e58 = k_v4;
                                if (_e58 < 6u32) {
                                } else {
                                    break 'l2;
                                }
                                {
                                    let _e61 = stiffness_v3;
                                    let _e66 = k_v4;
                                    let _e70 = m.matrix[50u32.wrapping_mul(6u32.wrapping_mul(t_e2[t]).wrapping_add(_e66)) as usize];
                                    stiffness_v3 = (_e61 + _e70);
                                }
                            }
                            let _e72 = k_v4;
                            k_v4 = _e72.wrapping_add(1u32);
                        }
                        let _e78 = m.params.first_part;
                        let _e80 = d_v0;
                        let held_e86 = <[f32; 6]>::load(m.frames, 16 * (_e78.wrapping_add(8u32.wrapping_mul(_e80)).wrapping_add(t_e2[t]) as usize) + 10);
                        let _e87 = (held_e86)[0];
                        let _e88 = (held_e86)[1];
                        let _e89 = (held_e86)[2];
                        let _e90 = [_e87, _e88, _e89];
                        let _e91 = (held_e86)[1];
                        let _e92 = (held_e86)[3];
                        let _e93 = (held_e86)[4];
                        let _e94 = [_e91, _e92, _e93];
                        let _e95 = (held_e86)[2];
                        let _e96 = (held_e86)[4];
                        let _e97 = (held_e86)[5];
                        let _e98 = [_e95, _e96, _e97];
                        let mut rows_v5: [[f32; 3]; 3];
                        rows_v5 = [_e90, _e94, _e98];
                        let mut r_v6: u32;
                        r_v6 = 0u32;
                        'l3: loop {
                            'c3: {
                                let _e103 = r_v6;
                                if (_e103 < 3u32) {
                                } else {
                                    break 'l3;
                                }
                                {
                                    let mut k_v7: u32;
                                    k_v7 = 0u32;
                                    'l4: loop {
                                        'c4: {
                                            let _e108 = k_v7;
                                            if (_e108 < 3u32) {
                                            } else {
                                                break 'l4;
                                            }
                                            {
                                                let _e115 = r_v6;
                                                let _e123 = k_v7;
                                                let _e128 = m.matrix[49u32.wrapping_mul(6u32.wrapping_mul(t_e2[t]).wrapping_add(_e115).wrapping_add(3u32)).wrapping_add(6u32.wrapping_mul(t_e2[t])).wrapping_add(_e123).wrapping_add(3u32) as usize];
                                                let _e129 = stiffness_v3;
                                                let _e130 = r_v6;
                                                let _e132 = k_v7;
                                                let _e134 = rows_v5[_e130 as usize][_e132 as usize];
                                                m.matrix[49u32.wrapping_mul(6u32.wrapping_mul(t_e2[t]).wrapping_add(_e115).wrapping_add(3u32)).wrapping_add(6u32.wrapping_mul(t_e2[t])).wrapping_add(_e123).wrapping_add(3u32) as usize] = (_e128 + (_e129 * _e134));
                                            }
                                        }
                                        let _e137 = k_v7;
                                        k_v7 = _e137.wrapping_add(1u32);
                                    }
                                }
                            }
                            let _e140 = r_v6;
                            r_v6 = _e140.wrapping_add(1u32);
                        }
                    }
                }
                for t in 0..192 {
                    if (t_e2[t] < 48u32) {
                        let _e149 = m.matrix[50u32.wrapping_mul(t_e2[t]) as usize];
                        m.matrix[50u32.wrapping_mul(t_e2[t]) as usize] = (_e149 * 1.000004f32);
                        let _e158 = m.matrix[50u32.wrapping_mul(t_e2[t]) as usize];
                        m.diagonal[t_e2[t] as usize] = _e158;
                    }
                }
                k_v8 = 0u32;
                'l5: loop {
                    'c5: {
                        let _e161 = k_v8;
                        if (_e161 < 48u32) {
                        } else {
                            break 'l5;
                        }
                        {
                            for t in 0..192 {
                                if (t_e2[t] < 48u32) {
                                    let _e170 = k_v8;
                                    let _e174 = m.matrix[49u32.wrapping_mul(_e170).wrapping_add(t_e2[t]) as usize];
                                    m.pivot_row[t_e2[t] as usize] = _e174;
                                    let _e180 = k_v8;
                                    let _e183 = m.matrix[49u32.wrapping_mul(t_e2[t]).wrapping_add(_e180) as usize];
                                    m.pivot_column[t_e2[t] as usize] = _e183;
                                }
                            }
                            let _e185 = k_v8;
                            let _e190 = k_v8;
                            for t in 0..192 {
                                let pivot_e187 = m.pivot_row[_e185 as usize];
                                let _e192 = m.diagonal[_e190 as usize];
                                let is_zero_e195 = (!(pivot_e187 > (1e-6f32 * _e192)));
                                let _e198 = m.pivot_column[row_e4[t] as usize];
                                let factor_e199 = (_e198 / pivot_e187);
                                let mut j_v9: u32;
                                j_v9 = lane_e6[t];
                                'l6: loop {
                                    'c6: {
                                        let _e201 = j_v9;
                                        if (_e201 < 48u32) {
                                        } else {
                                            break 'l6;
                                        }
                                        {
                                            let _e206 = j_v9;
                                            let at_e207 = 49u32.wrapping_mul(row_e4[t]).wrapping_add(_e206);
                                            if is_zero_e195 {
                                                let _e208 = k_v8;
                                                let mut local_v10: bool;
                                                if (!(row_e4[t] == _e208)) {
                                                    let _e213 = j_v9;
                                                    let _e214 = k_v8;
                                                    local_v10 = (_e213 == _e214);
                                                } else {
                                                    local_v10 = true;
                                                }
                                                let _e217 = local_v10;
                                                if _e217 {
                                                    m.matrix[at_e207 as usize] = 0.0f32;
                                                }
                                            } else {
                                                let _e221 = k_v8;
                                                if (row_e4[t] == _e221) {
                                                    let _e226 = j_v9;
                                                    let _e228 = m.pivot_row[_e226 as usize];
                                                    let _e229 = j_v9;
                                                    let _e230 = k_v8;
                                                    m.matrix[at_e207 as usize] = ((if (_e229 == _e230) { 1.0f32 } else { _e228 }) / pivot_e187);
                                                } else {
                                                    let _e235 = j_v9;
                                                    let _e236 = k_v8;
                                                    if (_e235 == _e236) {
                                                        m.matrix[at_e207 as usize] = (-factor_e199);
                                                    } else {
                                                        let _e243 = m.matrix[at_e207 as usize];
                                                        let _e245 = j_v9;
                                                        let _e247 = m.pivot_row[_e245 as usize];
                                                        m.matrix[at_e207 as usize] = (_e243 - (factor_e199 * _e247));
                                                    }
                                                }
                                            }
                                        }
                                    }
                                    let _e250 = j_v9;
                                    j_v9 = _e250.wrapping_add(4u32);
                                }
                            }
                        }
                    }
                    let _e253 = k_v8;
                    k_v8 = _e253.wrapping_add(1u32);
                }
                for t in 0..192 {
                    let mut k_v11: u32;
                    k_v11 = t_e2[t];
                    'l7: loop {
                        'c7: {
                            let _e257 = k_v11;
                            if (_e257 < 2304u32) {
                            } else {
                                break 'l7;
                            }
                            {
                                let _e260 = k_v11;
                                let r_e262 = (_e260 / 48u32);
                                let _e263 = k_v11;
                                let c_e265 = (_e263 % 48u32);
                                let _e270 = m.params.first_inverse;
                                let _e271 = d_v0;
                                let _e274 = k_v11;
                                let _e282 = m.matrix[49u32.wrapping_mul(r_e262).wrapping_add(c_e265) as usize];
                                let _e288 = m.matrix[49u32.wrapping_mul(c_e265).wrapping_add(r_e262) as usize];
                                Stored::store((0.5f32 * (_e282 + _e288)), m.inverses, 1 * (2304u32.wrapping_mul(_e270.wrapping_add(_e271)).wrapping_add(_e274) as usize));
                            }
                        }
                        let _e292 = k_v11;
                        k_v11 = _e292.wrapping_add(192u32);
                    }
                }
            }
        }
        let _e295 = d_v0;
        d_v0 = _e295.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let tables = bound.read(0);
    let couplings = bound.read(1);
    let touching = bound.read(2);
    let pressed = bound.read(3);
    let frames = bound.read(4);
    let mut inverses = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        tables: &tables,
        couplings: &couplings,
        touching: &touching,
        pressed: &pressed,
        frames: &frames,
        inverses: &mut inverses,
        matrix: [0.0f32; 2352],
        pivot_row: [0.0f32; 48],
        pivot_column: [0.0f32; 48],
        diagonal: [0.0f32; 48],
    };
    for group in 0..bound.workgroups() {
        m.matrix = [0.0f32; 2352];
        m.pivot_row = [0.0f32; 48];
        m.pivot_column = [0.0f32; 48];
        m.diagonal = [0.0f32; 48];
        main(&mut m, group as u32);
    }
}
}
