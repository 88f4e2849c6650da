// Written from `shader/backward/color_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "color_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/color_rows.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write, Write, Write, Write, Write, Write, Write],
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
pub const FEWEST_SETTLED: u32 = 64u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub first: u32,
    pub end: u32,
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::color_rows::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    displacements: &'a [u32],
    rows: &'a mut [u32],
    buckets: &'a mut [u32],
    in_use: &'a mut [u32],
    claims: &'a mut [u32],
    waiting: &'a mut [u32],
    order: &'a mut [u32],
    color_ends: &'a mut [u32],
    left: u32,
    shared_first: u32,
    shared_count: u32,
    most: u32,
    places: [u32; 129],
}

pub fn key_of(candidate_a0: u32) -> u32 {
    return candidate_a0.wrapping_mul(2654435761u32);
}

pub fn first_free(used_a0: [u32; 4]) -> u32 {
    let mut word_v0: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e3 = word_v0;
            if (_e3 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e6 = word_v0;
                if ((used_a0)[_e6 as usize] != 4294967295u32) {
                    let _e11 = word_v0;
                    let _e13 = word_v0;
                    return 32u32.wrapping_mul(_e11).wrapping_add((!(used_a0)[_e13 as usize]).trailing_zeros());
                }
            }
        }
        let _e18 = word_v0;
        word_v0 = _e18.wrapping_add(1u32);
    }
    return 128u32;
}

pub fn moves(m: &mut Memory<'_>, v_a0: u32) -> bool {
    let _e4 = <f32>::load(m.displacements, 4 * (v_a0 as usize) + 3);
    return (_e4 > 0.0f32);
}

pub fn claim(m: &mut Memory<'_>, r_a0: u32) {
    let mut k_v0: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e3 = k_v0;
            if (_e3 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v0;
                let v_e11 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 1 * (_e9 as usize));
                let _e12 = moves(m, v_e11);
                if _e12 {
                    let _e18 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 14);
                    let _e19 = key_of(_e18);
                    { let old = <u32>::load(m.claims, 1 * (v_e11 as usize)); let new = old.min(_e19); Stored::store(new, m.claims, 1 * (v_e11 as usize)); old };
                }
            }
        }
        let _e21 = k_v0;
        k_v0 = _e21.wrapping_add(1u32);
    }
}

pub fn clear(m: &mut Memory<'_>, r_a0: u32) {
    let mut k_v0: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e3 = k_v0;
            if (_e3 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v0;
                let v_e11 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 1 * (_e9 as usize));
                let _e12 = moves(m, v_e11);
                let mut local_v1: bool;
                if _e12 {
                    let _e17 = <u32>::load(m.claims, 1 * (v_e11 as usize));
                    let _e21 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 14);
                    let _e22 = key_of(_e21);
                    local_v1 = (_e17 == _e22);
                } else {
                    local_v1 = false;
                }
                let _e25 = local_v1;
                if _e25 {
                    Stored::store([0u32; 4], m.in_use, 4 * (v_e11 as usize));
                }
            }
        }
        let _e30 = k_v0;
        k_v0 = _e30.wrapping_add(1u32);
    }
}

pub fn holds_all(m: &mut Memory<'_>, r_a0: u32) -> bool {
    let mut k_v0: u32 = 0u32;
    let _e4 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 14);
    let key_e5 = key_of(_e4);
    'l0: loop {
        'c0: {
            let _e8 = k_v0;
            if (_e8 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e14 = k_v0;
                let v_e16 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 1 * (_e14 as usize));
                let _e17 = moves(m, v_e16);
                let mut local_v1: bool;
                if _e17 {
                    let _e22 = <u32>::load(m.claims, 1 * (v_e16 as usize));
                    local_v1 = (_e22 != key_e5);
                } else {
                    local_v1 = false;
                }
                let _e25 = local_v1;
                if _e25 {
                    return false;
                }
            }
        }
        let _e27 = k_v0;
        k_v0 = _e27.wrapping_add(1u32);
    }
    return true;
}

pub fn color_row(m: &mut Memory<'_>, r_a0: u32) {
    let mut used_v0: [u32; 4] = [0u32; 4];
    let mut k_v1: u32 = 0u32;
    let mut bit_v2: [u32; 4] = [0u32; 4];
    let mut k_v3: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e6 = k_v1;
            if (_e6 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e12 = k_v1;
                let v_e14 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 1 * (_e12 as usize));
                let _e15 = moves(m, v_e14);
                if _e15 {
                    let _e16 = used_v0;
                    let _e19 = <[u32; 4]>::load(m.in_use, 4 * (v_e14 as usize));
                    used_v0 = zip(_e16, _e19, |x, y| (x | y));
                }
            }
        }
        let _e21 = k_v1;
        k_v1 = _e21.wrapping_add(1u32);
    }
    let _e24 = used_v0;
    let color_e25 = first_free(_e24);
    Stored::store(color_e25, m.rows, 24 * (r_a0 as usize) + 15);
    if (color_e25 == 128u32) {
        return;
    }
    bit_v2[(color_e25 / 32u32) as usize] = 1u32.wrapping_shl((color_e25 % 32u32));
    'l1: loop {
        'c1: {
            let _e43 = k_v3;
            if (_e43 < 4u32) {
            } else {
                break 'l1;
            }
            {
                let _e49 = k_v3;
                let v_e51 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 1 * (_e49 as usize));
                let _e52 = moves(m, v_e51);
                if _e52 {
                    let _e55 = <[u32; 4]>::load(m.in_use, 4 * (v_e51 as usize));
                    let _e56 = bit_v2;
                    Stored::store(zip(_e55, _e56, |x, y| (x | y)), m.in_use, 4 * (v_e51 as usize));
                }
            }
        }
        let _e58 = k_v3;
        k_v3 = _e58.wrapping_add(1u32);
    }
}

pub fn has_part(m: &mut Memory<'_>, r_a0: u32, k_a1: u32) -> bool {
    let _e6 = <u32>::load(m.rows, 24 * (r_a0 as usize) + 1 * (k_a1 as usize));
    let _e7 = moves(m, _e6);
    let mut local_v0: bool;
    if _e7 {
        let _e14 = <f32>::load(m.rows, 24 * (r_a0 as usize) + 4 + 1 * (k_a1 as usize));
        local_v0 = (_e14 != 0.0f32);
    } else {
        local_v0 = false;
    }
    let _e18 = local_v0;
    return _e18;
}

pub fn split_masses(m: &mut Memory<'_>, first_a0: [u32; 256], end_a1: [u32; 256], thread_a2: [u32; 256]) {
    for t in 0..256 {
        let mut place_v0: u32;
        place_v0 = first_a0[t].wrapping_add(thread_a2[t]);
        'l0: loop {
            'c0: {
                let _e5 = place_v0;
                if (_e5 < end_a1[t]) {
                } else {
                    break 'l0;
                }
                {
                    let _e8 = place_v0;
                    let r_e10 = <u32>::load(m.order, 1 * (_e8 as usize));
                    let mut k_v1: u32;
                    k_v1 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e13 = k_v1;
                            if (_e13 < 4u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e16 = k_v1;
                                let _e17 = has_part(m, r_e10, _e16);
                                if _e17 {
                                    let _e22 = k_v1;
                                    let _e24 = <u32>::load(m.rows, 24 * (r_e10 as usize) + 1 * (_e22 as usize));
                                    Stored::store(0u32, m.claims, 1 * (_e24 as usize));
                                }
                            }
                        }
                        let _e27 = k_v1;
                        k_v1 = _e27.wrapping_add(1u32);
                    }
                }
            }
            let _e30 = place_v0;
            place_v0 = _e30.wrapping_add(256u32);
        }
    }
    for t in 0..256 {
        let mut place_v2: u32;
        place_v2 = first_a0[t].wrapping_add(thread_a2[t]);
        'l2: loop {
            'c2: {
                let _e35 = place_v2;
                if (_e35 < end_a1[t]) {
                } else {
                    break 'l2;
                }
                {
                    let _e38 = place_v2;
                    let r_e40 = <u32>::load(m.order, 1 * (_e38 as usize));
                    let mut k_v3: u32;
                    k_v3 = 0u32;
                    'l3: loop {
                        'c3: {
                            let _e43 = k_v3;
                            if (_e43 < 4u32) {
                            } else {
                                break 'l3;
                            }
                            {
                                let _e46 = k_v3;
                                let _e47 = has_part(m, r_e40, _e46);
                                if _e47 {
                                    let _e52 = k_v3;
                                    let _e54 = <u32>::load(m.rows, 24 * (r_e40 as usize) + 1 * (_e52 as usize));
                                    { let old = <u32>::load(m.claims, 1 * (_e54 as usize)); let new = old.wrapping_add(1u32); Stored::store(new, m.claims, 1 * (_e54 as usize)); old };
                                }
                            }
                        }
                        let _e58 = k_v3;
                        k_v3 = _e58.wrapping_add(1u32);
                    }
                }
            }
            let _e61 = place_v2;
            place_v2 = _e61.wrapping_add(256u32);
        }
    }
    for t in 0..256 {
        let mut place_v4: u32;
        place_v4 = first_a0[t].wrapping_add(thread_a2[t]);
        'l4: loop {
            'c4: {
                let _e66 = place_v4;
                if (_e66 < end_a1[t]) {
                } else {
                    break 'l4;
                }
                {
                    let _e69 = place_v4;
                    let r_e71 = <u32>::load(m.order, 1 * (_e69 as usize));
                    let mut diagonal_v5: f32;
                    diagonal_v5 = 0.0f32;
                    let mut k_v6: u32;
                    k_v6 = 0u32;
                    'l5: loop {
                        'c5: {
                            let _e76 = k_v6;
                            if (_e76 < 4u32) {
                            } else {
                                break 'l5;
                            }
                            {
                                let _e79 = k_v6;
                                let _e80 = has_part(m, r_e71, _e79);
                                if _e80 {
                                    let _e84 = k_v6;
                                    let v_e86 = <u32>::load(m.rows, 24 * (r_e71 as usize) + 1 * (_e84 as usize));
                                    let parts_e89 = <u32>::load(m.claims, 1 * (v_e86 as usize));
                                    { let old = m.most; let new = old.max(parts_e89); m.most = new; old };
                                    let _e92 = diagonal_v5;
                                    let _e97 = <f32>::load(m.displacements, 4 * (v_e86 as usize) + 3);
                                    let _e102 = k_v6;
                                    let _e104 = <f32>::load(m.rows, 24 * (r_e71 as usize) + 4 + 1 * (_e102 as usize));
                                    let _e109 = k_v6;
                                    let _e111 = <f32>::load(m.rows, 24 * (r_e71 as usize) + 4 + 1 * (_e109 as usize));
                                    diagonal_v5 = (_e92 + ((((parts_e89 as f32) * _e97) * _e104) * _e111));
                                }
                            }
                        }
                        let _e114 = k_v6;
                        k_v6 = _e114.wrapping_add(1u32);
                    }
                    let _e120 = diagonal_v5;
                    let _e123 = diagonal_v5;
                    Stored::store((if (_e123 > 0.0f32) { (1.0f32 / _e120) } else { 0.0f32 }), m.rows, 24 * (r_e71 as usize) + 12);
                }
            }
            let _e128 = place_v4;
            place_v4 = _e128.wrapping_add(256u32);
        }
    }
}

pub fn sort_by_color(m: &mut Memory<'_>, bucket_a0: [u32; 256], first_a1: [u32; 256], all_a2: [u32; 256], thread_a3: [u32; 256]) {
    let mut color_v3: [u32; 256] = [0u32; 256];
    for t in 0..256 {
        let mut color_v0: u32;
        color_v0 = thread_a3[t];
        'l0: loop {
            'c0: {
                let _e5 = color_v0;
                if (_e5 <= 128u32) {
                } else {
                    break 'l0;
                }
                {
                    let _e9 = color_v0;
                    m.places[_e9 as usize] = 0u32;
                }
            }
            let _e12 = color_v0;
            color_v0 = _e12.wrapping_add(256u32);
        }
        if (thread_a3[t] == 0u32) {
            m.most = 0u32;
        }
    }
    for t in 0..256 {
        let mut place_v1: u32;
        place_v1 = first_a1[t].wrapping_add(thread_a3[t]);
        'l1: loop {
            'c1: {
                let _e21 = place_v1;
                if (_e21 < first_a1[t].wrapping_add(all_a2[t])) {
                } else {
                    break 'l1;
                }
                {
                    let _e25 = place_v1;
                    let r_e27 = <u32>::load(m.order, 1 * (_e25 as usize));
                    let _e29 = place_v1;
                    Stored::store(r_e27, m.waiting, 1 * (_e29 as usize));
                    let _e35 = <u32>::load(m.rows, 24 * (r_e27 as usize) + 15);
                    { let old = m.places[_e35 as usize]; let new = old.wrapping_add(1u32); m.places[_e35 as usize] = new; old };
                }
            }
            let _e39 = place_v1;
            place_v1 = _e39.wrapping_add(256u32);
        }
    }
    for t in 0..256 {
        if (thread_a3[t] == 0u32) {
            let mut sum_v2: u32;
            sum_v2 = first_a1[t];
            'l2: loop {
                'c2: {
                    let _e47 = color_v3[t];
                    if (_e47 < 128u32) {
                    } else {
                        break 'l2;
                    }
                    {
                        let _e51 = color_v3[t];
                        let rows_of_color_e53 = m.places[_e51 as usize];
                        if (rows_of_color_e53 == 0u32) {
                            break 'l2;
                        }
                        let _e57 = color_v3[t];
                        let _e59 = sum_v2;
                        m.places[_e57 as usize] = _e59;
                        let _e60 = sum_v2;
                        sum_v2 = _e60.wrapping_add(rows_of_color_e53);
                        let _e63 = color_v3[t];
                        let _e66 = sum_v2;
                        Stored::store(_e66, m.color_ends, 1 * (first_a1[t].wrapping_add(_e63) as usize));
                    }
                }
                let _e67 = color_v3[t];
                color_v3[t] = _e67.wrapping_add(1u32);
            }
            let _e73 = color_v3[t];
            Stored::store(_e73, m.buckets, 4 * (bucket_a0[t] as usize) + 2);
            let _e75 = sum_v2;
            m.shared_first = _e75;
            let _e79 = m.places[128];
            m.shared_count = _e79;
            let _e82 = sum_v2;
            m.places[128] = _e82;
        }
    }
    for t in 0..256 {
        let mut place_v4: u32;
        place_v4 = first_a1[t].wrapping_add(thread_a3[t]);
        'l3: loop {
            'c3: {
                let _e85 = place_v4;
                if (_e85 < first_a1[t].wrapping_add(all_a2[t])) {
                } else {
                    break 'l3;
                }
                {
                    let _e89 = place_v4;
                    let r_e91 = <u32>::load(m.waiting, 1 * (_e89 as usize));
                    let _e97 = <u32>::load(m.rows, 24 * (r_e91 as usize) + 15);
                    let _e100 = { let old = m.places[_e97 as usize]; let new = old.wrapping_add(1u32); m.places[_e97 as usize] = new; old };
                    Stored::store(r_e91, m.order, 1 * (_e100 as usize));
                }
            }
            let _e102 = place_v4;
            place_v4 = _e102.wrapping_add(256u32);
        }
    }
    let uncolored_e106 = { let t = 0; m.shared_count };
    if (uncolored_e106 > 0u32) {
        let _e110 = { let t = 0; m.shared_first };
        split_masses(m, std::array::from_fn::<_, 256, _>(|t| _e110), std::array::from_fn::<_, 256, _>(|t| first_a1[t].wrapping_add(all_a2[t])), std::array::from_fn::<_, 256, _>(|t| thread_a3[t]));
    }
    for t in 0..256 {
        if (thread_a3[t] == 0u32) {
            let _e118 = m.most;
            Stored::store(_e118, m.buckets, 4 * (bucket_a0[t] as usize) + 3);
        }
    }
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut bucket_v0: u32 = 0u32;
    let mut here_v2: u32 = 0u32;
    let mut next_v3: u32 = 0u32;
    let mut count_v4: u32 = 0u32;
    let mut round_v5: u32 = 0u32;
    let _e4 = m.params.first;
    bucket_v0 = _e4.wrapping_add(([group, 0, 0])[0]);
    'l0: loop {
        'c0: {
            let _e8 = bucket_v0;
            let _e11 = m.params.end;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                for t in 0..256 {
                    if (([t as u32, 0, 0])[0] == 0u32) {
                        let _e18 = bucket_v0;
                        let _e21 = <u32>::load(m.buckets, 4 * (_e18 as usize));
                        m.shared_first = _e21;
                        let _e24 = bucket_v0;
                        let _e27 = <u32>::load(m.buckets, 4 * (_e24 as usize) + 1);
                        let _e29 = bucket_v0;
                        let _e32 = <u32>::load(m.buckets, 4 * (_e29 as usize));
                        m.shared_count = _e27.wrapping_sub(_e32);
                    }
                }
                let first_e35 = { let t = 0; m.shared_first };
                let all_e37 = { let t = 0; m.shared_count };
                if (all_e37 == 0u32) {
                    for t in 0..256 {
                        if (([t as u32, 0, 0])[0] == 0u32) {
                            let _e44 = bucket_v0;
                            Stored::store(0u32, m.buckets, 4 * (_e44 as usize) + 2);
                        }
                    }
                    break 'c0;
                }
                for t in 0..256 {
                    let mut place_v1: u32;
                    place_v1 = ([t as u32, 0, 0])[0];
                    'l1: loop {
                        'c1: {
                            let _e50 = place_v1;
                            if (_e50 < all_e37) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e53 = place_v1;
                                let _e57 = place_v1;
                                let _e60 = <u32>::load(m.order, 1 * (first_e35.wrapping_add(_e57) as usize));
                                Stored::store(_e60, m.waiting, 1 * (first_e35.wrapping_add(_e53) as usize));
                            }
                        }
                        let _e61 = place_v1;
                        place_v1 = _e61.wrapping_add(256u32);
                    }
                }
                here_v2 = first_e35;
                let _e67 = m.params.capacity;
                next_v3 = _e67.wrapping_add(first_e35);
                count_v4 = all_e37;
                round_v5 = 0u32;
                'l2: loop {
                    'c2: {
                        let _e73 = count_v4;
                        if (_e73 > 0u32) {
                        } else {
                            break 'l2;
                        }
                        {
                            for t in 0..256 {
                                if (([t as u32, 0, 0])[0] == 0u32) {
                                    m.left = 0u32;
                                }
                                let mut place_v6: u32;
                                place_v6 = ([t as u32, 0, 0])[0];
                                'l3: loop {
                                    'c3: {
                                        let _e83 = place_v6;
                                        let _e84 = count_v4;
                                        if (_e83 < _e84) {
                                        } else {
                                            break 'l3;
                                        }
                                        {
                                            let _e87 = here_v2;
                                            let _e88 = place_v6;
                                            let r_e91 = <u32>::load(m.waiting, 1 * (_e87.wrapping_add(_e88) as usize));
                                            let mut k_v7: u32;
                                            k_v7 = 0u32;
                                            'l4: loop {
                                                'c4: {
                                                    let _e94 = k_v7;
                                                    if (_e94 < 4u32) {
                                                    } else {
                                                        break 'l4;
                                                    }
                                                    {
                                                        let _e101 = k_v7;
                                                        let _e103 = <u32>::load(m.rows, 24 * (r_e91 as usize) + 1 * (_e101 as usize));
                                                        Stored::store(4294967295u32, m.claims, 1 * (_e103 as usize));
                                                    }
                                                }
                                                let _e106 = k_v7;
                                                k_v7 = _e106.wrapping_add(1u32);
                                            }
                                        }
                                    }
                                    let _e109 = place_v6;
                                    place_v6 = _e109.wrapping_add(256u32);
                                }
                            }
                            for t in 0..256 {
                                let mut place_v8: u32;
                                place_v8 = ([t as u32, 0, 0])[0];
                                'l5: loop {
                                    'c5: {
                                        let _e114 = place_v8;
                                        let _e115 = count_v4;
                                        if (_e114 < _e115) {
                                        } else {
                                            break 'l5;
                                        }
                                        {
                                            let _e118 = here_v2;
                                            let _e119 = place_v8;
                                            let _e122 = <u32>::load(m.waiting, 1 * (_e118.wrapping_add(_e119) as usize));
                                            claim(m, _e122);
                                        }
                                    }
                                    let _e123 = place_v8;
                                    place_v8 = _e123.wrapping_add(256u32);
                                }
                            }
                            let _e126 = round_v5;
                            for t in 0..256 {
                                if (_e126 == 0u32) {
                                    let mut place_v9: u32;
                                    place_v9 = ([t as u32, 0, 0])[0];
                                    'l6: loop {
                                        'c6: {
                                            let _e131 = place_v9;
                                            let _e132 = count_v4;
                                            if (_e131 < _e132) {
                                            } else {
                                                break 'l6;
                                            }
                                            {
                                                let _e135 = here_v2;
                                                let _e136 = place_v9;
                                                let _e139 = <u32>::load(m.waiting, 1 * (_e135.wrapping_add(_e136) as usize));
                                                clear(m, _e139);
                                            }
                                        }
                                        let _e140 = place_v9;
                                        place_v9 = _e140.wrapping_add(256u32);
                                    }
                                }
                            }
                            for t in 0..256 {
                                let mut place_v10: u32;
                                place_v10 = ([t as u32, 0, 0])[0];
                                'l7: loop {
                                    'c7: {
                                        let _e145 = place_v10;
                                        let _e146 = count_v4;
                                        if (_e145 < _e146) {
                                        } else {
                                            break 'l7;
                                        }
                                        {
                                            let _e149 = here_v2;
                                            let _e150 = place_v10;
                                            let r_e153 = <u32>::load(m.waiting, 1 * (_e149.wrapping_add(_e150) as usize));
                                            let _e154 = holds_all(m, r_e153);
                                            if _e154 {
                                                color_row(m, r_e153);
                                            } else {
                                                let _e156 = next_v3;
                                                let _e159 = { let old = m.left; let new = old.wrapping_add(1u32); m.left = new; old };
                                                Stored::store(r_e153, m.waiting, 1 * (_e156.wrapping_add(_e159) as usize));
                                            }
                                        }
                                    }
                                    let _e162 = place_v10;
                                    place_v10 = _e162.wrapping_add(256u32);
                                }
                            }
                            let before_e171 = count_v4;
                            for t in 0..256 {
                                if (([t as u32, 0, 0])[0] == 0u32) {
                                    let _e170 = m.left;
                                    m.shared_count = _e170;
                                }
                            }
                            let _e173 = { let t = 0; m.shared_count };
                            count_v4 = _e173;
                            let swapped_e174 = here_v2;
                            let _e175 = next_v3;
                            here_v2 = _e175;
                            next_v3 = swapped_e174;
                            let _e177 = count_v4;
                            if (64u32.wrapping_mul(before_e171.wrapping_sub(_e177)) < before_e171) {
                                break 'l2;
                            }
                        }
                    }
                    let _e181 = round_v5;
                    round_v5 = _e181.wrapping_add(1u32);
                }
                for t in 0..256 {
                    let mut place_v11: u32;
                    place_v11 = ([t as u32, 0, 0])[0];
                    'l8: loop {
                        'c8: {
                            let _e186 = place_v11;
                            let _e187 = count_v4;
                            if (_e186 < _e187) {
                            } else {
                                break 'l8;
                            }
                            {
                                let _e191 = here_v2;
                                let _e192 = place_v11;
                                let _e195 = <u32>::load(m.waiting, 1 * (_e191.wrapping_add(_e192) as usize));
                                Stored::store(128u32, m.rows, 24 * (_e195 as usize) + 15);
                            }
                        }
                        let _e199 = place_v11;
                        place_v11 = _e199.wrapping_add(256u32);
                    }
                }
                let _e202 = bucket_v0;
                sort_by_color(m, std::array::from_fn::<_, 256, _>(|t| _e202), std::array::from_fn::<_, 256, _>(|t| first_e35), std::array::from_fn::<_, 256, _>(|t| all_e37), std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]));
            }
        }
        let _e204 = bucket_v0;
        bucket_v0 = _e204.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let displacements = bound.read(0);
    let mut rows = bound.write(1);
    let mut buckets = bound.write(2);
    let mut in_use = bound.write(3);
    let mut claims = bound.write(4);
    let mut waiting = bound.write(5);
    let mut order = bound.write(6);
    let mut color_ends = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        displacements: &displacements,
        rows: &mut rows,
        buckets: &mut buckets,
        in_use: &mut in_use,
        claims: &mut claims,
        waiting: &mut waiting,
        order: &mut order,
        color_ends: &mut color_ends,
        left: 0u32,
        shared_first: 0u32,
        shared_count: 0u32,
        most: 0u32,
        places: [0u32; 129],
    };
    for group in 0..bound.workgroups() {
        m.left = 0u32;
        m.shared_first = 0u32;
        m.shared_count = 0u32;
        m.most = 0u32;
        m.places = [0u32; 129];
        main(&mut m, group as u32);
    }
}
}
