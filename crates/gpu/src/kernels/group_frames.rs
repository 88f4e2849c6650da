// Written from `shader/preconditioner/group_frames.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "group_frames",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/groups.wgsl"),
        include_str!("../../shader/shared/eigen.wgsl"),
        include_str!("../../shader/preconditioner/group_frames.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const NEGLIGIBLE: f32 = 1e-8f32;
pub const SWEEPS: u32 = 6u32;
pub const ORDER: u32 = 3u32;
pub const SMALLEST_MOMENT: f32 = 0.0001f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub count: u32,
    pub first: u32,
    pub first_part: u32,
    pub parts: u32,
    pub width: u32,
    pub first_domain: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::group_frames::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Frame {
    pub center: [i32; 3],
    pub size: f32,
    pub moment: [f32; 6],
    pub held: [f32; 6],
}

impl Frame {
    const ZERO: Self = Self {
        center: [0i32; 3],
        size: 0.0f32,
        moment: [0.0f32; 6],
        held: [0.0f32; 6],
    };
}

impl Stored for Frame {
    const WORDS: usize = 16;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            center: <[i32; 3]>::load(words, at + 0),
            size: <f32>::load(words, at + 3),
            moment: <[f32; 6]>::load(words, at + 4),
            held: <[f32; 6]>::load(words, at + 10),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.center.store(words, at + 0);
        self.size.store(words, at + 3);
        self.moment.store(words, at + 4);
        self.held.store(words, at + 10);
    }
}

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    slots: &'a mut [u32],
    frames: &'a mut [u32],
    links: &'a mut [u32],
}

pub fn between(a_a0: [i32; 3], b_a1: [i32; 3], quantum_a2: f32) -> [f32; 3] {
    return zip(b_a1, a_a0, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * quantum_a2));
}

pub fn is_definite(matrix_a0: [f32; 9], largest_a1: f32) -> bool {
    let mut k_v1: u32 = 0u32;
    let mut a_v0: [f32; 9];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e5 = k_v1;
            if (_e5 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v1;
                let pivot_e12 = a_v0[4u32.wrapping_mul(_e9) as usize];
                if (pivot_e12 <= (1e-6f32 * largest_a1)) {
                    return false;
                }
                let _e17 = k_v1;
                let mut i_v2: u32;
                i_v2 = _e17.wrapping_add(1u32);
                'l1: loop {
                    'c1: {
                        let _e21 = i_v2;
                        if (_e21 < 3u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e25 = i_v2;
                            let _e27 = k_v1;
                            let _e30 = a_v0[3u32.wrapping_mul(_e25).wrapping_add(_e27) as usize];
                            let factor_e31 = (_e30 / pivot_e12);
                            let _e32 = k_v1;
                            let mut j_v3: u32;
                            j_v3 = _e32.wrapping_add(1u32);
                            'l2: loop {
                                'c2: {
                                    let _e36 = j_v3;
                                    if (_e36 < 3u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e40 = i_v2;
                                        let _e42 = j_v3;
                                        let _e45 = a_v0[3u32.wrapping_mul(_e40).wrapping_add(_e42) as usize];
                                        let _e47 = k_v1;
                                        let _e49 = j_v3;
                                        let _e52 = a_v0[3u32.wrapping_mul(_e47).wrapping_add(_e49) as usize];
                                        a_v0[3u32.wrapping_mul(_e40).wrapping_add(_e42) as usize] = (_e45 - (factor_e31 * _e52));
                                    }
                                }
                                let _e55 = j_v3;
                                j_v3 = _e55.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e58 = i_v2;
                    i_v2 = _e58.wrapping_add(1u32);
                }
            }
        }
        let _e61 = k_v1;
        k_v1 = _e61.wrapping_add(1u32);
    }
    return true;
}

pub fn filtered(value_a0: f32) -> f32 {
    return (if (value_a0 <= 0.0f32) { 1.0f32 } else { 0.0f32 });
}

pub fn filtered_matrix(matrix_a0: [f32; 9]) -> [f32; 9] {
    let mut largest_v1: f32 = 0.0f32;
    let mut k_v2: u32 = 0u32;
    let mut v_v3: [f32; 9] = [0.0f32; 9];
    let mut k_v4: u32 = 0u32;
    let mut sweep_v5: u32 = 0u32;
    let mut sum_v10: [f32; 9] = [0.0f32; 9];
    let mut k_v11: u32 = 0u32;
    let mut a_v0: [f32; 9];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e6 = k_v2;
            if (_e6 < 9u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = largest_v1;
                let _e10 = k_v2;
                let _e12 = a_v0[_e10 as usize];
                largest_v1 = _e9.max(_e12.abs());
            }
        }
        let _e15 = k_v2;
        k_v2 = _e15.wrapping_add(1u32);
    }
    let _e18 = a_v0;
    let _e19 = largest_v1;
    let _e20 = is_definite(_e18, _e19);
    if _e20 {
        let _e21 = a_v0;
        return _e21;
    }
    'l1: loop {
        'c1: {
            let _e25 = k_v4;
            if (_e25 < 3u32) {
            } else {
                break 'l1;
            }
            {
                let _e29 = k_v4;
                v_v3[4u32.wrapping_mul(_e29) as usize] = 1.0f32;
            }
        }
        let _e33 = k_v4;
        k_v4 = _e33.wrapping_add(1u32);
    }
    'l2: loop {
        'c2: {
            let _e38 = sweep_v5;
            if (_e38 < 6u32) {
            } else {
                break 'l2;
            }
            {
                let mut p_v6: u32;
                p_v6 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e43 = p_v6;
                        if (_e43 < 3u32) {
                        } else {
                            break 'l3;
                        }
                        {
                            let _e46 = p_v6;
                            let mut q_v7: u32;
                            q_v7 = _e46.wrapping_add(1u32);
                            'l4: loop {
                                'c4: {
                                    let _e50 = q_v7;
                                    if (_e50 < 3u32) {
                                    } else {
                                        break 'l4;
                                    }
                                    {
                                        let _e54 = p_v6;
                                        let _e56 = q_v7;
                                        let pq_e59 = a_v0[3u32.wrapping_mul(_e54).wrapping_add(_e56) as usize];
                                        let _e62 = largest_v1;
                                        if (pq_e59.abs() > (1e-8f32 * _e62)) {
                                            let _e66 = q_v7;
                                            let _e69 = a_v0[4u32.wrapping_mul(_e66) as usize];
                                            let _e71 = p_v6;
                                            let _e74 = a_v0[4u32.wrapping_mul(_e71) as usize];
                                            let tau_e78 = ((_e69 - _e74) / (2.0f32 * pq_e59));
                                            let size_e86 = (1.0f32 / (tau_e78.abs() + (1.0f32 + (tau_e78 * tau_e78)).sqrt()));
                                            let t_e90 = (if (tau_e78 >= 0.0f32) { size_e86 } else { (-size_e86) });
                                            let c_e96 = (1.0f32 / (1.0f32 + (t_e90 * t_e90)).sqrt());
                                            let s_e97 = (t_e90 * c_e96);
                                            let mut k_v8: u32;
                                            k_v8 = 0u32;
                                            'l5: loop {
                                                'c5: {
                                                    let _e100 = k_v8;
                                                    if (_e100 < 3u32) {
                                                    } else {
                                                        break 'l5;
                                                    }
                                                    {
                                                        let _e104 = k_v8;
                                                        let _e106 = p_v6;
                                                        let x_e109 = a_v0[3u32.wrapping_mul(_e104).wrapping_add(_e106) as usize];
                                                        let _e111 = k_v8;
                                                        let _e113 = q_v7;
                                                        let y_e116 = a_v0[3u32.wrapping_mul(_e111).wrapping_add(_e113) as usize];
                                                        let _e118 = k_v8;
                                                        let _e120 = p_v6;
                                                        a_v0[3u32.wrapping_mul(_e118).wrapping_add(_e120) as usize] = ((c_e96 * x_e109) - (s_e97 * y_e116));
                                                        let _e127 = k_v8;
                                                        let _e129 = q_v7;
                                                        a_v0[3u32.wrapping_mul(_e127).wrapping_add(_e129) as usize] = ((s_e97 * x_e109) + (c_e96 * y_e116));
                                                        let _e136 = k_v8;
                                                        let _e138 = p_v6;
                                                        let z_e141 = v_v3[3u32.wrapping_mul(_e136).wrapping_add(_e138) as usize];
                                                        let _e143 = k_v8;
                                                        let _e145 = q_v7;
                                                        let w_e148 = v_v3[3u32.wrapping_mul(_e143).wrapping_add(_e145) as usize];
                                                        let _e150 = k_v8;
                                                        let _e152 = p_v6;
                                                        v_v3[3u32.wrapping_mul(_e150).wrapping_add(_e152) as usize] = ((c_e96 * z_e141) - (s_e97 * w_e148));
                                                        let _e159 = k_v8;
                                                        let _e161 = q_v7;
                                                        v_v3[3u32.wrapping_mul(_e159).wrapping_add(_e161) as usize] = ((s_e97 * z_e141) + (c_e96 * w_e148));
                                                    }
                                                }
                                                let _e167 = k_v8;
                                                k_v8 = _e167.wrapping_add(1u32);
                                            }
                                            let mut k_v9: u32;
                                            k_v9 = 0u32;
                                            'l6: loop {
                                                'c6: {
                                                    let _e172 = k_v9;
                                                    if (_e172 < 3u32) {
                                                    } else {
                                                        break 'l6;
                                                    }
                                                    {
                                                        let _e176 = p_v6;
                                                        let _e178 = k_v9;
                                                        let x_e181 = a_v0[3u32.wrapping_mul(_e176).wrapping_add(_e178) as usize];
                                                        let _e183 = q_v7;
                                                        let _e185 = k_v9;
                                                        let y_e188 = a_v0[3u32.wrapping_mul(_e183).wrapping_add(_e185) as usize];
                                                        let _e190 = p_v6;
                                                        let _e192 = k_v9;
                                                        a_v0[3u32.wrapping_mul(_e190).wrapping_add(_e192) as usize] = ((c_e96 * x_e181) - (s_e97 * y_e188));
                                                        let _e199 = q_v7;
                                                        let _e201 = k_v9;
                                                        a_v0[3u32.wrapping_mul(_e199).wrapping_add(_e201) as usize] = ((s_e97 * x_e181) + (c_e96 * y_e188));
                                                    }
                                                }
                                                let _e207 = k_v9;
                                                k_v9 = _e207.wrapping_add(1u32);
                                            }
                                        }
                                    }
                                }
                                let _e210 = q_v7;
                                q_v7 = _e210.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e213 = p_v6;
                    p_v6 = _e213.wrapping_add(1u32);
                }
            }
        }
        let _e216 = sweep_v5;
        sweep_v5 = _e216.wrapping_add(1u32);
    }
    'l7: loop {
        'c7: {
            let _e222 = k_v11;
            if (_e222 < 3u32) {
            } else {
                break 'l7;
            }
            {
                let _e226 = k_v11;
                let _e229 = a_v0[4u32.wrapping_mul(_e226) as usize];
                let value_e230 = filtered(_e229);
                let mut i_v12: u32;
                i_v12 = 0u32;
                'l8: loop {
                    'c8: {
                        let _e233 = i_v12;
                        if (_e233 < 3u32) {
                        } else {
                            break 'l8;
                        }
                        {
                            let mut j_v13: u32;
                            j_v13 = 0u32;
                            'l9: loop {
                                'c9: {
                                    let _e238 = j_v13;
                                    if (_e238 < 3u32) {
                                    } else {
                                        break 'l9;
                                    }
                                    {
                                        let _e242 = i_v12;
                                        let _e244 = j_v13;
                                        let _e247 = sum_v10[3u32.wrapping_mul(_e242).wrapping_add(_e244) as usize];
                                        let _e249 = i_v12;
                                        let _e251 = k_v11;
                                        let _e254 = v_v3[3u32.wrapping_mul(_e249).wrapping_add(_e251) as usize];
                                        let _e257 = j_v13;
                                        let _e259 = k_v11;
                                        let _e262 = v_v3[3u32.wrapping_mul(_e257).wrapping_add(_e259) as usize];
                                        sum_v10[3u32.wrapping_mul(_e242).wrapping_add(_e244) as usize] = (_e247 + ((value_e230 * _e254) * _e262));
                                    }
                                }
                                let _e265 = j_v13;
                                j_v13 = _e265.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e268 = i_v12;
                    i_v12 = _e268.wrapping_add(1u32);
                }
            }
        }
        let _e271 = k_v11;
        k_v11 = _e271.wrapping_add(1u32);
    }
    let _e274 = sum_v10;
    return _e274;
}

pub fn moment_of(way_a0: [f32; 3]) -> [f32; 6] {
    let _e3 = ((way_a0)[0] * (way_a0)[0]);
    let _e6 = ((way_a0)[0] * (way_a0)[1]);
    let _e9 = ((way_a0)[0] * (way_a0)[2]);
    let _e12 = ((way_a0)[1] * (way_a0)[1]);
    let _e15 = ((way_a0)[1] * (way_a0)[2]);
    let _e18 = ((way_a0)[2] * (way_a0)[2]);
    return [_e3, _e6, _e9, _e12, _e15, _e18];
}

pub fn held_by(m_a0: [f32; 6]) -> [f32; 6] {
    let mut held_v0: [f32; 6] = [0.0f32; 6];
    let trace_e5 = (((m_a0)[0] + (m_a0)[3]) + (m_a0)[5]);
    let shift_e7 = (0.9999f32 * trace_e5);
    let _e9 = (shift_e7 - (m_a0)[0]);
    let _e11 = (-(m_a0)[1]);
    let _e13 = (-(m_a0)[2]);
    let _e15 = (-(m_a0)[1]);
    let _e17 = (shift_e7 - (m_a0)[3]);
    let _e19 = (-(m_a0)[4]);
    let _e21 = (-(m_a0)[2]);
    let _e23 = (-(m_a0)[4]);
    let _e25 = (shift_e7 - (m_a0)[5]);
    let matrix_e26 = [_e9, _e11, _e13, _e15, _e17, _e19, _e21, _e23, _e25];
    let _e28 = is_definite(matrix_e26, trace_e5);
    if (!_e28) {
        let sum_e30 = filtered_matrix(matrix_e26);
        let _e31 = (sum_e30)[0];
        let _e32 = (sum_e30)[1];
        let _e33 = (sum_e30)[2];
        let _e34 = (sum_e30)[4];
        let _e35 = (sum_e30)[5];
        let _e36 = (sum_e30)[8];
        held_v0 = [_e31, _e32, _e33, _e34, _e35, _e36];
    }
    let _e38 = held_v0;
    return _e38;
}

pub fn of_nodes(m: &mut Memory<'_>, g_a0: u32) -> Frame {
    let mut frame_v0: Frame = Frame::ZERO;
    let mut count_v1: f32 = 0.0f32;
    let mut sum_v2: [f32; 3] = [0.0f32; 3];
    let _e10 = m.params.width;
    let first_e14 = <u32>::load(m.slots, 12 * (_e10.wrapping_mul(g_a0) as usize));
    if (first_e14 == 4294967295u32) {
        let _e17 = frame_v0;
        return _e17;
    }
    let _e20 = <[i32; 4]>::load(m.positions, 4 * (first_e14 as usize));
    let origin_e21 = swizzle(_e20, [0, 1, 2]);
    let _e24 = m.params.width;
    let mut s_v3: u32;
    s_v3 = _e24.wrapping_mul(g_a0);
    'l0: loop {
        'c0: {
            let _e27 = s_v3;
            let _e30 = m.params.width;
            if (_e27 < _e30.wrapping_mul(g_a0.wrapping_add(1u32))) {
            } else {
                break 'l0;
            }
            {
                let _e36 = s_v3;
                let node_e39 = <u32>::load(m.slots, 12 * (_e36 as usize));
                if (node_e39 != 4294967295u32) {
                    let _e42 = sum_v2;
                    let _e45 = <[i32; 4]>::load(m.positions, 4 * (node_e39 as usize));
                    sum_v2 = zip(_e42, zip(swizzle(_e45, [0, 1, 2]), origin_e21, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)), |x, y| (x + y));
                    let _e50 = count_v1;
                    count_v1 = (_e50 + 1.0f32);
                }
            }
        }
        let _e53 = s_v3;
        s_v3 = _e53.wrapping_add(1u32);
    }
    let _e57 = sum_v2;
    let _e58 = count_v1;
    frame_v0.center = zip(origin_e21, zip(_e57, [_e58; 3], |x, y| (x / y)).map(|x| (x as i32)), |x, y| x.wrapping_add(y));
    let _e65 = m.params.width;
    let mut s_v4: u32;
    s_v4 = _e65.wrapping_mul(g_a0);
    'l1: loop {
        'c1: {
            let _e68 = s_v4;
            let _e71 = m.params.width;
            if (_e68 < _e71.wrapping_mul(g_a0.wrapping_add(1u32))) {
            } else {
                break 'l1;
            }
            {
                let _e77 = s_v4;
                let node_e80 = <u32>::load(m.slots, 12 * (_e77 as usize));
                if (node_e80 != 4294967295u32) {
                    let _e85 = frame_v0.size;
                    let _e87 = frame_v0.center;
                    let _e90 = <[i32; 4]>::load(m.positions, 4 * (node_e80 as usize));
                    let _e94 = m.params.quantum;
                    let _e95 = between(_e87, swizzle(_e90, [0, 1, 2]), _e94);
                    frame_v0.size = _e85.max(dot(_e95, _e95).sqrt());
                }
            }
        }
        let _e98 = s_v4;
        s_v4 = _e98.wrapping_add(1u32);
    }
    let _e102 = frame_v0.size;
    let _e105 = m.params.quantum;
    if (_e102 <= _e105) {
        frame_v0.size = 1.0f32;
    }
    let _e111 = m.params.width;
    let mut s_v5: u32;
    s_v5 = _e111.wrapping_mul(g_a0);
    'l2: loop {
        'c2: {
            let _e114 = s_v5;
            let _e117 = m.params.width;
            if (_e114 < _e117.wrapping_mul(g_a0.wrapping_add(1u32))) {
            } else {
                break 'l2;
            }
            {
                let _e123 = s_v5;
                let node_e126 = <u32>::load(m.slots, 12 * (_e123 as usize));
                if (node_e126 != 4294967295u32) {
                    let _e130 = frame_v0.center;
                    let _e133 = <[i32; 4]>::load(m.positions, 4 * (node_e126 as usize));
                    let _e137 = m.params.quantum;
                    let _e138 = between(_e130, swizzle(_e133, [0, 1, 2]), _e137);
                    let _e140 = frame_v0.size;
                    let arm_e142 = zip(_e138, [_e140; 3], |x, y| (x / y));
                    let moment_e143 = moment_of(arm_e142);
                    let mut k_v6: u32;
                    k_v6 = 0u32;
                    'l3: loop {
                        'c3: {
                            let _e146 = k_v6;
                            if (_e146 < 6u32) {
                            } else {
                                break 'l3;
                            }
                            {
                                let _e150 = k_v6;
                                let _e152 = frame_v0.moment[_e150 as usize];
                                let _e153 = k_v6;
                                let _e155 = count_v1;
                                frame_v0.moment[_e150 as usize] = (_e152 + ((moment_e143)[_e153 as usize] / _e155));
                            }
                        }
                        let _e158 = k_v6;
                        k_v6 = _e158.wrapping_add(1u32);
                    }
                    let _e163 = m.params.width;
                    if (_e163 == 8u32) {
                        let _e167 = s_v5;
                        let _e170 = (arm_e142)[0];
                        let _e171 = (arm_e142)[1];
                        let _e172 = (arm_e142)[2];
                        Stored::store([_e170, _e171, _e172], m.slots, 12 * (_e167 as usize) + 7);
                    }
                }
            }
        }
        let _e174 = s_v5;
        s_v5 = _e174.wrapping_add(1u32);
    }
    let _e179 = frame_v0.moment;
    let _e180 = held_by(_e179);
    frame_v0.held = _e180;
    let _e181 = frame_v0;
    return _e181;
}

pub fn of_groups(m: &mut Memory<'_>, g_a0: u32) -> Frame {
    let mut frame_v0: Frame = Frame::ZERO;
    let mut sum_v1: [f32; 3] = [0.0f32; 3];
    let mut m_v2: u32 = 0u32;
    let mut m_v3: u32 = 0u32;
    let mut m_v4: u32 = 0u32;
    let _e5 = m.params.parts;
    let count_e9 = 8u32.min(_e5.wrapping_sub(8u32.wrapping_mul(g_a0)));
    let _e12 = m.params.first_part;
    let first_e15 = _e12.wrapping_add(8u32.wrapping_mul(g_a0));
    let origin_e19 = <[i32; 3]>::load(m.frames, 16 * (first_e15 as usize));
    'l0: loop {
        'c0: {
            let _e25 = m_v2;
            if (_e25 < count_e9) {
            } else {
                break 'l0;
            }
            {
                let _e27 = sum_v1;
                let _e29 = m_v2;
                let _e33 = <[i32; 3]>::load(m.frames, 16 * (first_e15.wrapping_add(_e29) as usize));
                sum_v1 = zip(_e27, zip(_e33, origin_e19, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)), |x, y| (x + y));
            }
        }
        let _e37 = m_v2;
        m_v2 = _e37.wrapping_add(1u32);
    }
    let _e41 = sum_v1;
    frame_v0.center = zip(origin_e19, zip(_e41, [(count_e9 as f32); 3], |x, y| (x / y)).map(|x| (x as i32)), |x, y| x.wrapping_add(y));
    'l1: loop {
        'c1: {
            let _e49 = m_v3;
            if (_e49 < count_e9) {
            } else {
                break 'l1;
            }
            {
                let _e52 = m_v3;
                let part_e55 = <Frame>::load(m.frames, 16 * (first_e15.wrapping_add(_e52) as usize));
                let _e58 = frame_v0.size;
                let _e60 = frame_v0.center;
                let _e64 = m.params.quantum;
                let _e65 = between(_e60, (part_e55).center, _e64);
                frame_v0.size = _e58.max((dot(_e65, _e65).sqrt() + (part_e55).size));
            }
        }
        let _e70 = m_v3;
        m_v3 = _e70.wrapping_add(1u32);
    }
    'l2: loop {
        'c2: {
            let _e75 = m_v4;
            if (_e75 < count_e9) {
            } else {
                break 'l2;
            }
            {
                let _e78 = m_v4;
                let part_e81 = <Frame>::load(m.frames, 16 * (first_e15.wrapping_add(_e78) as usize));
                let _e83 = frame_v0.center;
                let _e87 = m.params.quantum;
                let _e88 = between(_e83, (part_e81).center, _e87);
                let _e90 = frame_v0.size;
                let moment_e93 = moment_of(zip(_e88, [_e90; 3], |x, y| (x / y)));
                let _e96 = frame_v0.size;
                let ratio_e97 = ((part_e81).size / _e96);
                let mut k_v5: u32;
                k_v5 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e100 = k_v5;
                        if (_e100 < 6u32) {
                        } else {
                            break 'l3;
                        }
                        {
                            let _e104 = k_v5;
                            let _e106 = frame_v0.moment[_e104 as usize];
                            let _e107 = k_v5;
                            let _e111 = k_v5;
                            frame_v0.moment[_e104 as usize] = (_e106 + (((moment_e93)[_e107 as usize] + ((ratio_e97 * ratio_e97) * ((part_e81).moment)[_e111 as usize])) / (count_e9 as f32)));
                        }
                    }
                    let _e118 = k_v5;
                    k_v5 = _e118.wrapping_add(1u32);
                }
            }
        }
        let _e121 = m_v4;
        m_v4 = _e121.wrapping_add(1u32);
    }
    let _e126 = frame_v0.moment;
    let _e127 = held_by(_e126);
    frame_v0.held = _e127;
    let _e128 = frame_v0;
    return _e128;
}

pub fn link_of(m: &mut Memory<'_>, g_a0: u32, m_a1: u32, whole_a2: Frame) -> [f32; 4] {
    let _e8 = m.params.parts;
    if (8u32.wrapping_mul(g_a0).wrapping_add(m_a1) < _e8) {
        let _e13 = m.params.first_part;
        let part_e19 = <Frame>::load(m.frames, 16 * (_e13.wrapping_add(8u32.wrapping_mul(g_a0)).wrapping_add(m_a1) as usize));
        if ((part_e19).size > 0.0f32) {
            let _e27 = m.params.quantum;
            let _e28 = between((whole_a2).center, (part_e19).center, _e27);
            let _e29 = (part_e19).size;
            return zip([(_e28)[0], (_e28)[1], (_e28)[2], _e29], [(whole_a2).size; 4], |x, y| (x / y));
        }
    }
    return [0.0f32; 4];
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut g_v0: u32;
    g_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = g_v0;
            let _e6 = m.params.count;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let mut frame_v1: Frame;
                frame_v1 = Frame::ZERO;
                let _e12 = m.params.width;
                if (_e12 > 0u32) {
                    let _e15 = g_v0;
                    let _e16 = of_nodes(m, _e15);
                    frame_v1 = _e16;
                } else {
                    let _e17 = g_v0;
                    let _e18 = of_groups(m, _e17);
                    frame_v1 = _e18;
                }
                let _e22 = m.params.first;
                let _e23 = g_v0;
                let _e26 = frame_v1;
                Stored::store(_e26, m.frames, 16 * (_e22.wrapping_add(_e23) as usize));
                let mut m_v2: u32;
                m_v2 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e29 = m_v2;
                        let mut local_v3: bool;
                        if (_e29 < 8u32) {
                            let _e36 = m.params.parts;
                            local_v3 = (_e36 > 0u32);
                        } else {
                            local_v3 = false;
                        }
                        let _e40 = local_v3;
                        if _e40 {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e41 = g_v0;
                            let _e42 = m_v2;
                            let _e43 = frame_v1;
                            let link_e44 = link_of(m, _e41, _e42, _e43);
                            let _e47 = m.params.width;
                            if (_e47 > 0u32) {
                                let _e52 = g_v0;
                                let _e55 = m_v2;
                                let _e60 = (link_e44)[0];
                                let _e61 = (link_e44)[1];
                                Stored::store([_e60, _e61], m.slots, 12 * (64u32.wrapping_mul(_e52).wrapping_add(8u32.wrapping_mul(_e55)) as usize) + 10);
                                let _e65 = g_v0;
                                let _e68 = m_v2;
                                let _e75 = (link_e44)[2];
                                let _e76 = (link_e44)[3];
                                Stored::store([_e75, _e76], m.slots, 12 * (64u32.wrapping_mul(_e65).wrapping_add(8u32.wrapping_mul(_e68)).wrapping_add(1u32) as usize) + 10);
                            } else {
                                let _e82 = m.params.first_domain;
                                let _e83 = g_v0;
                                let _e86 = m_v2;
                                Stored::store(link_e44, m.links, 4 * (8u32.wrapping_mul(_e82.wrapping_add(_e83)).wrapping_add(_e86) as usize));
                            }
                        }
                    }
                    let _e89 = m_v2;
                    m_v2 = _e89.wrapping_add(1u32);
                }
            }
        }
        let _e92 = g_v0;
        g_v0 = _e92.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let mut slots = bound.write(1);
    let mut frames = bound.write(2);
    let mut links = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        slots: &mut slots,
        frames: &mut frames,
        links: &mut links,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
