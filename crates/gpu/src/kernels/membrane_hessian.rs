// Written from `shader/elements/membrane_hessian.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "membrane_hessian",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/blocks.wgsl"),
        include_str!("../../shader/shared/triangle.wgsl"),
        include_str!("../../shader/shared/eigen.wgsl"),
        include_str!("../../shader/elements/membrane_hessian.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const TINY: f32 = 1e-18f32;
pub const MIN_RATIO: f32 = 0.05f32;
pub const NEGLIGIBLE: f32 = 1e-8f32;
pub const SWEEPS: u32 = 6u32;
pub const ORDER: u32 = 4u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ElementParams {
    pub elements: u32,
    pub first_block: u32,
    pub absolute: u32,
    pub rate: f32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::membrane_hessian::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Membrane {
    pub nodes: [u32; 3],
    pub area: f32,
    pub gradients: [f32; 4],
    pub stiffness: [f32; 4],
    pub damping: f32,
    pub padding: [u32; 3],
}

impl Membrane {
    const ZERO: Self = Self {
        nodes: [0u32; 3],
        area: 0.0f32,
        gradients: [0.0f32; 4],
        stiffness: [0.0f32; 4],
        damping: 0.0f32,
        padding: [0u32; 3],
    };
}

impl Stored for Membrane {
    const WORDS: usize = 16;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            nodes: <[u32; 3]>::load(words, at + 0),
            area: <f32>::load(words, at + 3),
            gradients: <[f32; 4]>::load(words, at + 4),
            stiffness: <[f32; 4]>::load(words, at + 8),
            damping: <f32>::load(words, at + 12),
            padding: <[u32; 3]>::load(words, at + 13),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.nodes.store(words, at + 0);
        self.area.store(words, at + 3);
        self.gradients.store(words, at + 4);
        self.stiffness.store(words, at + 8);
        self.damping.store(words, at + 12);
        self.padding.store(words, at + 13);
    }
}

#[derive(Clone, Copy)]
pub struct Stretch {
    pub u1: [f32; 3],
    pub u2: [f32; 3],
    pub c: f32,
    pub s: f32,
    pub s1: f32,
    pub s2: f32,
}

impl Stretch {
    const ZERO: Self = Self {
        u1: [0.0f32; 3],
        u2: [0.0f32; 3],
        c: 0.0f32,
        s: 0.0f32,
        s1: 0.0f32,
        s2: 0.0f32,
    };
}

impl Stored for Stretch {
    const WORDS: usize = 12;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            u1: <[f32; 3]>::load(words, at + 0),
            u2: <[f32; 3]>::load(words, at + 4),
            c: <f32>::load(words, at + 7),
            s: <f32>::load(words, at + 8),
            s1: <f32>::load(words, at + 9),
            s2: <f32>::load(words, at + 10),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.u1.store(words, at + 0);
        self.u2.store(words, at + 4);
        self.c.store(words, at + 7);
        self.s.store(words, at + 8);
        self.s1.store(words, at + 9);
        self.s2.store(words, at + 10);
    }
}

struct Memory<'a> {
    params: ElementParams,
    membranes: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    blocks: &'a mut [u32],
}

pub fn first_axis(a_a0: f32, d_a1: f32, b_a2: f32) -> [f32; 2] {
    let mut c_v0: f32 = 1.0f32;
    let mut s_v1: f32 = 0.0f32;
    if (b_a2.abs() > (1e-9f32 * (a_a0.abs() + d_a1.abs()))) {
        let tau_e17 = ((d_a1 - a_a0) / (2.0f32 * b_a2));
        let size_e25 = (1.0f32 / (tau_e17.abs() + (1.0f32 + (tau_e17 * tau_e17)).sqrt()));
        let t_e29 = (if (tau_e17 >= 0.0f32) { size_e25 } else { (-size_e25) });
        c_v0 = (1.0f32 / (1.0f32 + (t_e29 * t_e29)).sqrt());
        let _e37 = c_v0;
        s_v1 = ((-t_e29) * _e37);
    }
    let _e39 = c_v0;
    let _e40 = c_v0;
    let _e43 = c_v0;
    let _e46 = s_v1;
    let _e50 = s_v1;
    let _e51 = s_v1;
    let along_e54 = ((((_e39 * _e40) * a_a0) + (((2.0f32 * _e43) * _e46) * b_a2)) + ((_e50 * _e51) * d_a1));
    let _e55 = s_v1;
    let _e56 = s_v1;
    let _e59 = c_v0;
    let _e62 = s_v1;
    let _e66 = c_v0;
    let _e67 = c_v0;
    let across_e70 = ((((_e55 * _e56) * a_a0) - (((2.0f32 * _e59) * _e62) * b_a2)) + ((_e66 * _e67) * d_a1));
    if (along_e54 >= across_e70) {
        let _e72 = c_v0;
        let _e73 = s_v1;
        return [_e72, _e73];
    }
    let _e75 = s_v1;
    let _e76 = (-_e75);
    let _e77 = c_v0;
    return [_e76, _e77];
}

pub fn any_normal(u_a0: [f32; 3]) -> [f32; 3] {
    if ((u_a0)[0].abs() < 0.6f32) {
        let _e5 = (u_a0)[2];
        let _e7 = (-(u_a0)[1]);
        let _e9 = [0.0f32, _e5, _e7];
        return normalize(_e9);
    }
    let _e12 = (-(u_a0)[2]);
    let _e13 = (u_a0)[0];
    let _e15 = [_e12, 0.0f32, _e13];
    return normalize(_e15);
}

pub fn way(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e14 = m.params.quantum;
    return zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e14));
}

pub fn moved(m: &mut Memory<'_>, a_a0: u32, b_a1: u32) -> [f32; 3] {
    let _e4 = <[i32; 4]>::load(m.positions, 4 * (b_a1 as usize));
    let _e8 = <[i32; 4]>::load(m.positions, 4 * (a_a0 as usize));
    let _e13 = <[i32; 4]>::load(m.start, 4 * (b_a1 as usize));
    let _e17 = <[i32; 4]>::load(m.start, 4 * (a_a0 as usize));
    let _e24 = m.params.quantum;
    return zip(zip(swizzle(_e4, [0, 1, 2]), swizzle(_e8, [0, 1, 2]), |x, y| x.wrapping_sub(y)), zip(swizzle(_e13, [0, 1, 2]), swizzle(_e17, [0, 1, 2]), |x, y| x.wrapping_sub(y)), |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e24));
}

pub fn filtered(m: &mut Memory<'_>, curvature_a0: f32) -> f32 {
    let _e6 = m.params.absolute;
    return (if (_e6 == 1u32) { curvature_a0.abs() } else { curvature_a0.max(0.0f32) });
}

pub fn put(m: &mut Memory<'_>, block_a0: u32, a_a1: [f32; 3], b_a2: [f32; 3], c_a3: [f32; 3]) {
    let mut k_v0: u32 = 0u32;
    let _e7 = m.params.first_block;
    let at_e9 = 9u32.wrapping_mul(_e7.wrapping_add(block_a0));
    'l0: loop {
        'c0: {
            let _e12 = k_v0;
            if (_e12 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e16 = k_v0;
                let _e19 = k_v0;
                Stored::store((a_a1)[_e19 as usize], m.blocks, 1 * (at_e9.wrapping_add(_e16) as usize));
                let _e24 = k_v0;
                let _e27 = k_v0;
                Stored::store((b_a2)[_e27 as usize], m.blocks, 1 * (at_e9.wrapping_add(3u32).wrapping_add(_e24) as usize));
                let _e32 = k_v0;
                let _e35 = k_v0;
                Stored::store((c_a3)[_e35 as usize], m.blocks, 1 * (at_e9.wrapping_add(6u32).wrapping_add(_e32) as usize));
            }
        }
        let _e37 = k_v0;
        k_v0 = _e37.wrapping_add(1u32);
    }
}

pub fn stretch_of(f0_a0: [f32; 3], f1_a1: [f32; 3]) -> Stretch {
    let mut x_v0: Stretch = Stretch::ZERO;
    let axis_e6 = first_axis(dot(f0_a0, f0_a0), dot(f1_a1, f1_a1), dot(f0_a0, f1_a1));
    x_v0.c = (axis_e6)[0];
    x_v0.s = (axis_e6)[1];
    let _e12 = x_v0.c;
    let _e15 = x_v0.s;
    let w1_e17 = zip(f0_a0.map(|x| (x * _e12)), f1_a1.map(|x| (x * _e15)), |x, y| (x + y));
    x_v0.s1 = dot(w1_e17, w1_e17).sqrt();
    x_v0.u1 = [1.0f32, 0.0f32, 0.0f32];
    let _e26 = x_v0.s1;
    if (_e26 > 1e-18f32) {
        let _e31 = x_v0.s1;
        x_v0.u1 = zip(w1_e17, [_e31; 3], |x, y| (x / y));
    }
    let _e35 = x_v0.c;
    let _e38 = x_v0.s;
    let mut w2_v1: [f32; 3];
    w2_v1 = zip(f1_a1.map(|x| (x * _e35)), f0_a0.map(|x| (x * _e38)), |x, y| (x - y));
    let _e42 = w2_v1;
    let _e44 = x_v0.u1;
    let _e46 = x_v0.u1;
    let _e47 = w2_v1;
    w2_v1 = zip(_e42, _e44.map(|x| (x * dot(_e46, _e47))), |x, y| (x - y));
    let _e52 = w2_v1;
    x_v0.s2 = dot(_e52, _e52).sqrt();
    let _e56 = x_v0.u1;
    let _e57 = any_normal(_e56);
    x_v0.u2 = _e57;
    let _e59 = x_v0.s2;
    let _e61 = x_v0.s1;
    let mut local_v2: bool;
    if (_e59 > (1e-6f32 * _e61)) {
        let _e68 = x_v0.s2;
        local_v2 = (_e68 > 1e-18f32);
    } else {
        local_v2 = false;
    }
    let _e72 = local_v2;
    if _e72 {
        let _e74 = w2_v1;
        let _e76 = x_v0.s2;
        x_v0.u2 = zip(_e74, [_e76; 3], |x, y| (x / y));
    }
    let _e79 = x_v0;
    return _e79;
}

pub fn strain_of(x_a0: Stretch) -> [f32; 3] {
    let d1_e3 = ((x_a0).s1 - 1.0f32);
    let d2_e6 = ((x_a0).s2 - 1.0f32);
    let _e15 = ((((x_a0).c * (x_a0).c) * d1_e3) + (((x_a0).s * (x_a0).s) * d2_e6));
    let _e24 = ((((x_a0).s * (x_a0).s) * d1_e3) + (((x_a0).c * (x_a0).c) * d2_e6));
    let _e29 = (((x_a0).c * (x_a0).s) * (d1_e3 - d2_e6));
    return [_e15, _e24, _e29];
}

pub fn shares_of(x_a0: Stretch) -> [f32; 2] {
    let sum_e3 = ((x_a0).s1 + (x_a0).s2);
    if (sum_e3 > 1e-18f32) {
        let _e7 = ((x_a0).s1 / sum_e3);
        let _e9 = ((x_a0).s2 / sum_e3);
        return [_e7, _e9];
    }
    return [0.5f32, 0.5f32];
}

pub fn stress_of(stiffness_a0: [f32; 4], strain_a1: [f32; 3]) -> [f32; 3] {
    let _e8 = (((stiffness_a0)[0] * (strain_a1)[0]) + ((stiffness_a0)[1] * (strain_a1)[1]));
    let _e15 = (((stiffness_a0)[1] * (strain_a1)[0]) + ((stiffness_a0)[2] * (strain_a1)[1]));
    let _e20 = ((2.0f32 * (stiffness_a0)[3]) * (strain_a1)[2]);
    return [_e8, _e15, _e20];
}

pub fn stress_in(stiffness_a0: [f32; 4], strain_a1: [f32; 3], c_a2: f32, s_a3: f32) -> [f32; 3] {
    let t_e4 = stress_of(stiffness_a0, strain_a1);
    let _e17 = ((((c_a2 * c_a2) * (t_e4)[0]) + (((2.0f32 * c_a2) * s_a3) * (t_e4)[2])) + ((s_a3 * s_a3) * (t_e4)[1]));
    let _e30 = ((((s_a3 * s_a3) * (t_e4)[0]) - (((2.0f32 * c_a2) * s_a3) * (t_e4)[2])) + ((c_a2 * c_a2) * (t_e4)[1]));
    let _e41 = (((c_a2 * s_a3) * ((t_e4)[1] - (t_e4)[0])) + (((c_a2 * c_a2) - (s_a3 * s_a3)) * (t_e4)[2]));
    return [_e17, _e30, _e41];
}

pub fn increment(f0_a0: [f32; 3], f1_a1: [f32; 3], d0_a2: [f32; 3], d1_a3: [f32; 3]) -> [f32; 3] {
    let _e9 = (0.5f32 * dot(d0_a2, zip(f0_a0.map(|x| (2.0f32 * x)), d0_a2, |x, y| (x - y))));
    let _e15 = (0.5f32 * dot(d1_a3, zip(f1_a1.map(|x| (2.0f32 * x)), d1_a3, |x, y| (x - y))));
    let _e21 = (0.5f32 * (dot(d0_a2, f1_a1) + dot(zip(f0_a0, d0_a2, |x, y| (x - y)), d1_a3)));
    return [_e9, _e15, _e21];
}

pub fn is_definite(matrix_a0: [f32; 16], largest_a1: f32) -> bool {
    let mut k_v1: u32 = 0u32;
    let mut a_v0: [f32; 16];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e5 = k_v1;
            if (_e5 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v1;
                let pivot_e12 = a_v0[5u32.wrapping_mul(_e9) as usize];
                if (pivot_e12 <= (1e-6f32 * largest_a1)) {
                    return false;
                }
                let _e17 = k_v1;
                let mut i_v2: u32;
                i_v2 = _e17.wrapping_add(1u32);
                'l1: loop {
                    'c1: {
                        let _e21 = i_v2;
                        if (_e21 < 4u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e25 = i_v2;
                            let _e27 = k_v1;
                            let _e30 = a_v0[4u32.wrapping_mul(_e25).wrapping_add(_e27) as usize];
                            let factor_e31 = (_e30 / pivot_e12);
                            let _e32 = k_v1;
                            let mut j_v3: u32;
                            j_v3 = _e32.wrapping_add(1u32);
                            'l2: loop {
                                'c2: {
                                    let _e36 = j_v3;
                                    if (_e36 < 4u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e40 = i_v2;
                                        let _e42 = j_v3;
                                        let _e45 = a_v0[4u32.wrapping_mul(_e40).wrapping_add(_e42) as usize];
                                        let _e47 = k_v1;
                                        let _e49 = j_v3;
                                        let _e52 = a_v0[4u32.wrapping_mul(_e47).wrapping_add(_e49) as usize];
                                        a_v0[4u32.wrapping_mul(_e40).wrapping_add(_e42) as usize] = (_e45 - (factor_e31 * _e52));
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

pub fn filtered_matrix(m: &mut Memory<'_>, matrix_a0: [f32; 16]) -> [f32; 16] {
    let mut largest_v1: f32 = 0.0f32;
    let mut k_v2: u32 = 0u32;
    let mut v_v3: [f32; 16] = [0.0f32; 16];
    let mut k_v4: u32 = 0u32;
    let mut sweep_v5: u32 = 0u32;
    let mut sum_v10: [f32; 16] = [0.0f32; 16];
    let mut k_v11: u32 = 0u32;
    let mut a_v0: [f32; 16];
    a_v0 = matrix_a0;
    'l0: loop {
        'c0: {
            let _e6 = k_v2;
            if (_e6 < 16u32) {
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
            if (_e25 < 4u32) {
            } else {
                break 'l1;
            }
            {
                let _e29 = k_v4;
                v_v3[5u32.wrapping_mul(_e29) as usize] = 1.0f32;
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
                        if (_e43 < 4u32) {
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
                                    if (_e50 < 4u32) {
                                    } else {
                                        break 'l4;
                                    }
                                    {
                                        let _e54 = p_v6;
                                        let _e56 = q_v7;
                                        let pq_e59 = a_v0[4u32.wrapping_mul(_e54).wrapping_add(_e56) as usize];
                                        let _e62 = largest_v1;
                                        if (pq_e59.abs() > (1e-8f32 * _e62)) {
                                            let _e66 = q_v7;
                                            let _e69 = a_v0[5u32.wrapping_mul(_e66) as usize];
                                            let _e71 = p_v6;
                                            let _e74 = a_v0[5u32.wrapping_mul(_e71) as usize];
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
                                                    if (_e100 < 4u32) {
                                                    } else {
                                                        break 'l5;
                                                    }
                                                    {
                                                        let _e104 = k_v8;
                                                        let _e106 = p_v6;
                                                        let x_e109 = a_v0[4u32.wrapping_mul(_e104).wrapping_add(_e106) as usize];
                                                        let _e111 = k_v8;
                                                        let _e113 = q_v7;
                                                        let y_e116 = a_v0[4u32.wrapping_mul(_e111).wrapping_add(_e113) as usize];
                                                        let _e118 = k_v8;
                                                        let _e120 = p_v6;
                                                        a_v0[4u32.wrapping_mul(_e118).wrapping_add(_e120) as usize] = ((c_e96 * x_e109) - (s_e97 * y_e116));
                                                        let _e127 = k_v8;
                                                        let _e129 = q_v7;
                                                        a_v0[4u32.wrapping_mul(_e127).wrapping_add(_e129) as usize] = ((s_e97 * x_e109) + (c_e96 * y_e116));
                                                        let _e136 = k_v8;
                                                        let _e138 = p_v6;
                                                        let z_e141 = v_v3[4u32.wrapping_mul(_e136).wrapping_add(_e138) as usize];
                                                        let _e143 = k_v8;
                                                        let _e145 = q_v7;
                                                        let w_e148 = v_v3[4u32.wrapping_mul(_e143).wrapping_add(_e145) as usize];
                                                        let _e150 = k_v8;
                                                        let _e152 = p_v6;
                                                        v_v3[4u32.wrapping_mul(_e150).wrapping_add(_e152) as usize] = ((c_e96 * z_e141) - (s_e97 * w_e148));
                                                        let _e159 = k_v8;
                                                        let _e161 = q_v7;
                                                        v_v3[4u32.wrapping_mul(_e159).wrapping_add(_e161) as usize] = ((s_e97 * z_e141) + (c_e96 * w_e148));
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
                                                    if (_e172 < 4u32) {
                                                    } else {
                                                        break 'l6;
                                                    }
                                                    {
                                                        let _e176 = p_v6;
                                                        let _e178 = k_v9;
                                                        let x_e181 = a_v0[4u32.wrapping_mul(_e176).wrapping_add(_e178) as usize];
                                                        let _e183 = q_v7;
                                                        let _e185 = k_v9;
                                                        let y_e188 = a_v0[4u32.wrapping_mul(_e183).wrapping_add(_e185) as usize];
                                                        let _e190 = p_v6;
                                                        let _e192 = k_v9;
                                                        a_v0[4u32.wrapping_mul(_e190).wrapping_add(_e192) as usize] = ((c_e96 * x_e181) - (s_e97 * y_e188));
                                                        let _e199 = q_v7;
                                                        let _e201 = k_v9;
                                                        a_v0[4u32.wrapping_mul(_e199).wrapping_add(_e201) as usize] = ((s_e97 * x_e181) + (c_e96 * y_e188));
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
            if (_e222 < 4u32) {
            } else {
                break 'l7;
            }
            {
                let _e226 = k_v11;
                let _e229 = a_v0[5u32.wrapping_mul(_e226) as usize];
                let value_e230 = filtered(m, _e229);
                let mut i_v12: u32;
                i_v12 = 0u32;
                'l8: loop {
                    'c8: {
                        let _e233 = i_v12;
                        if (_e233 < 4u32) {
                        } else {
                            break 'l8;
                        }
                        {
                            let mut j_v13: u32;
                            j_v13 = 0u32;
                            'l9: loop {
                                'c9: {
                                    let _e238 = j_v13;
                                    if (_e238 < 4u32) {
                                    } else {
                                        break 'l9;
                                    }
                                    {
                                        let _e242 = i_v12;
                                        let _e244 = j_v13;
                                        let _e247 = sum_v10[4u32.wrapping_mul(_e242).wrapping_add(_e244) as usize];
                                        let _e249 = i_v12;
                                        let _e251 = k_v11;
                                        let _e254 = v_v3[4u32.wrapping_mul(_e249).wrapping_add(_e251) as usize];
                                        let _e257 = j_v13;
                                        let _e259 = k_v11;
                                        let _e262 = v_v3[4u32.wrapping_mul(_e257).wrapping_add(_e259) as usize];
                                        sum_v10[4u32.wrapping_mul(_e242).wrapping_add(_e244) as usize] = (_e247 + ((value_e230 * _e254) * _e262));
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

pub fn turned(stiffness_a0: [f32; 4], c_a1: f32, s_a2: f32) -> [[f32; 3]; 3] {
    let mut sum_v0: [[f32; 3]; 3] = [[0.0f32; 3]; 3];
    let mut k_v2: u32 = 0u32;
    let _e3 = (c_a1 * c_a1);
    let _e4 = (s_a2 * s_a2);
    let _e5 = (c_a1 * s_a2);
    let a_e6 = [_e3, _e4, _e5];
    let _e9 = (((-2.0f32) * c_a1) * s_a2);
    let _e12 = ((2.0f32 * c_a1) * s_a2);
    let _e15 = ((c_a1 * c_a1) - (s_a2 * s_a2));
    let b_e16 = [_e9, _e12, _e15];
    let _e17 = (s_a2 * s_a2);
    let _e18 = (c_a1 * c_a1);
    let _e20 = ((-c_a1) * s_a2);
    let d_e21 = [_e17, _e18, _e20];
    let mut turn_v1: [[f32; 3]; 3];
    turn_v1 = [a_e6, b_e16, d_e21];
    'l0: loop {
        'c0: {
            let _e27 = k_v2;
            if (_e27 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e30 = k_v2;
                let x_e32 = turn_v1[_e30 as usize];
                let _e39 = (((stiffness_a0)[0] * (x_e32)[0]) + ((stiffness_a0)[1] * (x_e32)[1]));
                let _e46 = (((stiffness_a0)[1] * (x_e32)[0]) + ((stiffness_a0)[2] * (x_e32)[1]));
                let _e51 = ((4.0f32 * (stiffness_a0)[3]) * (x_e32)[2]);
                let image_e52 = [_e39, _e46, _e51];
                let _e53 = k_v2;
                let _e55 = dot(a_e6, image_e52);
                let _e56 = dot(b_e16, image_e52);
                let _e57 = dot(d_e21, image_e52);
                sum_v0[_e53 as usize] = [_e55, _e56, _e57];
            }
        }
        let _e59 = k_v2;
        k_v2 = _e59.wrapping_add(1u32);
    }
    let _e62 = sum_v0;
    return _e62;
}

pub fn filtered_2(m: &mut Memory<'_>, m_a0: [f32; 3]) -> [f32; 3] {
    let axis_e4 = first_axis((m_a0)[0], (m_a0)[1], (m_a0)[2]);
    let c_e5 = (axis_e4)[0];
    let s_e6 = (axis_e4)[1];
    let along_e20 = filtered(m, ((((c_e5 * c_e5) * (m_a0)[0]) + (((2.0f32 * c_e5) * s_e6) * (m_a0)[2])) + ((s_e6 * s_e6) * (m_a0)[1])));
    let across_e34 = filtered(m, ((((s_e6 * s_e6) * (m_a0)[0]) - (((2.0f32 * c_e5) * s_e6) * (m_a0)[2])) + ((c_e5 * c_e5) * (m_a0)[1])));
    let _e39 = (((c_e5 * c_e5) * along_e20) + ((s_e6 * s_e6) * across_e34));
    let _e44 = (((s_e6 * s_e6) * along_e20) + ((c_e5 * c_e5) * across_e34));
    let _e47 = ((c_e5 * s_e6) * (along_e20 - across_e34));
    return [_e39, _e44, _e47];
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut e_v0: u32;
    e_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = e_v0;
            let _e6 = m.params.elements;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = e_v0;
                let m_e11 = <Membrane>::load(m.membranes, 16 * (_e9 as usize));
                let g_e12 = (m_e11).gradients;
                let e1_e17 = way(m, ((m_e11).nodes)[0], ((m_e11).nodes)[1]);
                let e2_e22 = way(m, ((m_e11).nodes)[0], ((m_e11).nodes)[2]);
                let f0_e27 = zip(e1_e17.map(|x| (x * (g_e12)[0])), e2_e22.map(|x| (x * (g_e12)[2])), |x, y| (x + y));
                let f1_e32 = zip(e1_e17.map(|x| (x * (g_e12)[1])), e2_e22.map(|x| (x * (g_e12)[3])), |x, y| (x + y));
                let x_e33 = stretch_of(f0_e27, f1_e32);
                let c_e34 = (x_e33).c;
                let s_e35 = (x_e33).s;
                let s1_e36 = (x_e33).s1;
                let s2_e37 = (x_e33).s2;
                let u1_e38 = (x_e33).u1;
                let u2_e39 = (x_e33).u2;
                let n_e40 = cross(u1_e38, u2_e39);
                let _e42 = strain_of(x_e33);
                let t_e43 = stress_in((m_e11).stiffness, _e42, c_e34, s_e35);
                let r_e44 = shares_of(x_e33);
                let sum_e45 = (s1_e36 + s2_e37);
                let divisor_e47 = sum_e45.max(0.05f32);
                let _e49 = turned((m_e11).stiffness, c_e34, s_e35);
                let mut stiffness_v1: [[f32; 3]; 3];
                stiffness_v1 = _e49;
                let _e51 = (r_e44)[0];
                let _e52 = (r_e44)[1];
                let mut weights_v2: [f32; 4];
                weights_v2 = [1.0f32, _e51, _e52, 1.0f32];
                let mut rates_v3: [f32; 4];
                rates_v3 = [0.0f32; 4];
                let mut viscous_v4: [f32; 3];
                viscous_v4 = [0.0f32; 3];
                let mut local_v5: bool;
                if ((m_e11).damping > 0.0f32) {
                    let _e70 = m.params.rate;
                    local_v5 = (_e70 > 0.0f32);
                } else {
                    local_v5 = false;
                }
                let _e74 = local_v5;
                if _e74 {
                    let _e78 = m.params.rate;
                    let factor_e79 = ((m_e11).damping * _e78);
                    let b1_e84 = moved(m, ((m_e11).nodes)[0], ((m_e11).nodes)[1]);
                    let b2_e89 = moved(m, ((m_e11).nodes)[0], ((m_e11).nodes)[2]);
                    let strain_e100 = increment(f0_e27, f1_e32, zip(b1_e84.map(|x| (x * (g_e12)[0])), b2_e89.map(|x| (x * (g_e12)[2])), |x, y| (x + y)), zip(b1_e84.map(|x| (x * (g_e12)[1])), b2_e89.map(|x| (x * (g_e12)[3])), |x, y| (x + y)));
                    let _e102 = stress_in((m_e11).stiffness, strain_e100, c_e34, s_e35);
                    viscous_v4 = _e102.map(|x| (x * factor_e79));
                    let _e105 = (0.5f32 * s1_e36);
                    let _e107 = (0.5f32 * s2_e37);
                    rates_v3 = [s1_e36, _e105, _e107, s2_e37].map(|x| (x * factor_e79.sqrt()));
                }
                let mut plane_v6: [f32; 16];
                plane_v6 = [0.0f32; 16];
                let mut i_v7: u32;
                i_v7 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e115 = i_v7;
                        if (_e115 < 4u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let mut j_v8: u32;
                            j_v8 = 0u32;
                            'l2: loop {
                                'c2: {
                                    let _e120 = j_v8;
                                    if (_e120 < 4u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e123 = j_v8;
                                        let _e129 = i_v7;
                                        let k_e135 = stiffness_v1[(_e123.wrapping_add(1u32) / 2u32) as usize][(_e129.wrapping_add(1u32) / 2u32) as usize];
                                        let _e137 = i_v7;
                                        let _e139 = j_v8;
                                        let _e142 = i_v7;
                                        let _e144 = weights_v2[_e142 as usize];
                                        let _e145 = j_v8;
                                        let _e147 = weights_v2[_e145 as usize];
                                        let _e149 = i_v7;
                                        let _e151 = rates_v3[_e149 as usize];
                                        let _e152 = j_v8;
                                        let _e154 = rates_v3[_e152 as usize];
                                        plane_v6[4u32.wrapping_mul(_e137).wrapping_add(_e139) as usize] = (((_e144 * _e147) + (_e151 * _e154)) * k_e135);
                                    }
                                }
                                let _e158 = j_v8;
                                j_v8 = _e158.wrapping_add(1u32);
                            }
                        }
                    }
                    let _e161 = i_v7;
                    i_v7 = _e161.wrapping_add(1u32);
                }
                let over_e166 = (1.0f32 / (divisor_e47 * divisor_e47));
                let t12_e170 = ((2.0f32 * (t_e43)[2]) / divisor_e47);
                let q1_e171 = (s1_e36 / divisor_e47);
                let q2_e172 = (s2_e37 / divisor_e47);
                let _e174 = plane_v6[1];
                plane_v6[1] = (_e174 + (t12_e170 * q2_e172));
                let _e178 = plane_v6[2];
                plane_v6[2] = (_e178 - (t12_e170 * q2_e172));
                let _e182 = plane_v6[4];
                plane_v6[4] = (_e182 + (t12_e170 * q2_e172));
                let _e186 = plane_v6[5];
                plane_v6[5] = (_e186 + ((((t_e43)[1] * (s2_e37 + (2.0f32 * s1_e36))) - ((t_e43)[0] * s1_e36)) * over_e166));
                let _e198 = plane_v6[6];
                plane_v6[6] = (_e198 - ((((t_e43)[0] * s2_e37) + ((t_e43)[1] * s1_e36)) * over_e166));
                let _e207 = plane_v6[7];
                plane_v6[7] = (_e207 - (t12_e170 * q1_e171));
                let _e211 = plane_v6[8];
                plane_v6[8] = (_e211 - (t12_e170 * q2_e172));
                let _e215 = plane_v6[9];
                plane_v6[9] = (_e215 - ((((t_e43)[0] * s2_e37) + ((t_e43)[1] * s1_e36)) * over_e166));
                let _e224 = plane_v6[10];
                plane_v6[10] = (_e224 + ((((t_e43)[0] * (s1_e36 + (2.0f32 * s2_e37))) - ((t_e43)[1] * s2_e37)) * over_e166));
                let _e236 = plane_v6[11];
                plane_v6[11] = (_e236 + (t12_e170 * q1_e171));
                let _e240 = plane_v6[13];
                plane_v6[13] = (_e240 - (t12_e170 * q1_e171));
                let _e244 = plane_v6[14];
                plane_v6[14] = (_e244 + (t12_e170 * q1_e171));
                let mut k_v9: u32;
                k_v9 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e249 = k_v9;
                        if (_e249 < 16u32) {
                        } else {
                            break 'l3;
                        }
                        {
                            let _e252 = k_v9;
                            let _e254 = plane_v6[_e252 as usize];
                            let _e256 = viscous_v4[0];
                            plane_v6[_e252 as usize] = (_e254 + _e256);
                            let _e258 = k_v9;
                            let _e262 = plane_v6[_e258.wrapping_add(1u32) as usize];
                            let _e264 = viscous_v4[2];
                            plane_v6[_e258.wrapping_add(1u32) as usize] = (_e262 + _e264);
                            let _e266 = k_v9;
                            let _e270 = plane_v6[_e266.wrapping_add(4u32) as usize];
                            let _e272 = viscous_v4[2];
                            plane_v6[_e266.wrapping_add(4u32) as usize] = (_e270 + _e272);
                            let _e274 = k_v9;
                            let _e278 = plane_v6[_e274.wrapping_add(5u32) as usize];
                            let _e280 = viscous_v4[1];
                            plane_v6[_e274.wrapping_add(5u32) as usize] = (_e278 + _e280);
                        }
                    }
                    let _e282 = k_v9;
                    k_v9 = _e282.wrapping_add(10u32);
                }
                let _e288 = ((t_e43)[0] / s1_e36.max(0.05f32));
                let _e292 = ((t_e43)[1] / s2_e37.max(0.05f32));
                let _e296 = ((2.0f32 * (t_e43)[2]) / divisor_e47);
                let _e298 = viscous_v4;
                let normal_e300 = filtered_2(m, zip([_e288, _e292, _e296], _e298, |x, y| (x + y)));
                let _e301 = plane_v6;
                let _e302 = filtered_matrix(m, _e301);
                plane_v6 = _e302;
                let mut shape_v10: [[f32; 2]; 3];
                shape_v10 = [[0.0f32; 2]; 3];
                let _e310 = ((c_e34 * (g_e12)[0]) + (s_e35 * (g_e12)[1]));
                let _e315 = ((c_e34 * (g_e12)[1]) - (s_e35 * (g_e12)[0]));
                shape_v10[1] = [_e310, _e315];
                let _e322 = ((c_e34 * (g_e12)[2]) + (s_e35 * (g_e12)[3]));
                let _e327 = ((c_e34 * (g_e12)[3]) - (s_e35 * (g_e12)[2]));
                shape_v10[2] = [_e322, _e327];
                let _e331 = shape_v10[1];
                let _e333 = shape_v10[2];
                shape_v10[0] = zip(_e331, _e333, |x, y| (x + y)).map(|x| (-x));
                let mut pair_v11: u32;
                pair_v11 = 0u32;
                'l4: loop {
                    'c4: {
                        let _e338 = pair_v11;
                        if (_e338 < 3u32) {
                        } else {
                            break 'l4;
                        }
                        {
                            let _e341 = pair_v11;
                            let a_e345 = shape_v10[(_e341 / 2u32) as usize];
                            let _e347 = pair_v11;
                            let b_e354 = shape_v10[1u32.wrapping_add((_e347.wrapping_add(1u32) / 2u32)) as usize];
                            let mut local_v12: [f32; 4];
                            local_v12 = [0.0f32; 4];
                            let mut k_v13: u32;
                            k_v13 = 0u32;
                            'l5: loop {
                                'c5: {
                                    let _e359 = k_v13;
                                    if (_e359 < 4u32) {
                                    } else {
                                        break 'l5;
                                    }
                                    {
                                        let _e363 = k_v13;
                                        let _e368 = k_v13;
                                        let at_e372 = 8u32.wrapping_mul((_e363 / 2u32)).wrapping_add(2u32.wrapping_mul((_e368 % 2u32)));
                                        let _e373 = k_v13;
                                        let _e378 = plane_v6[at_e372 as usize];
                                        let _e384 = plane_v6[at_e372.wrapping_add(1u32) as usize];
                                        let _e393 = plane_v6[at_e372.wrapping_add(4u32) as usize];
                                        let _e399 = plane_v6[at_e372.wrapping_add(5u32) as usize];
                                        local_v12[_e373 as usize] = ((m_e11).area * (((a_e345)[0] * ((_e378 * (b_e354)[0]) + (_e384 * (b_e354)[1]))) + ((a_e345)[1] * ((_e393 * (b_e354)[0]) + (_e399 * (b_e354)[1])))));
                                    }
                                }
                                let _e406 = k_v13;
                                k_v13 = _e406.wrapping_add(1u32);
                            }
                            let across_e429 = ((m_e11).area * (((a_e345)[0] * (((normal_e300)[0] * (b_e354)[0]) + ((normal_e300)[2] * (b_e354)[1]))) + ((a_e345)[1] * (((normal_e300)[2] * (b_e354)[0]) + ((normal_e300)[1] * (b_e354)[1])))));
                            let mut columns_v14: [[f32; 3]; 3];
                            columns_v14 = [[0.0f32; 3]; 3];
                            let mut k_v15: u32;
                            k_v15 = 0u32;
                            'l6: loop {
                                'c6: {
                                    let _e434 = k_v15;
                                    if (_e434 < 3u32) {
                                    } else {
                                        break 'l6;
                                    }
                                    {
                                        let _e437 = k_v15;
                                        let _e440 = local_v12[0];
                                        let _e441 = k_v15;
                                        let _e445 = local_v12[1];
                                        let _e446 = k_v15;
                                        let _e452 = local_v12[2];
                                        let _e453 = k_v15;
                                        let _e457 = local_v12[3];
                                        let _e458 = k_v15;
                                        let _e464 = k_v15;
                                        columns_v14[_e437 as usize] = zip(zip(u1_e38.map(|x| (x * ((_e440 * (u1_e38)[_e441 as usize]) + (_e445 * (u2_e39)[_e446 as usize])))), u2_e39.map(|x| (x * ((_e452 * (u1_e38)[_e453 as usize]) + (_e457 * (u2_e39)[_e458 as usize])))), |x, y| (x + y)), n_e40.map(|x| (x * (across_e429 * (n_e40)[_e464 as usize]))), |x, y| (x + y));
                                    }
                                }
                                let _e469 = k_v15;
                                k_v15 = _e469.wrapping_add(1u32);
                            }
                            let _e473 = e_v0;
                            let _e475 = pair_v11;
                            let _e478 = columns_v14[0];
                            let _e480 = columns_v14[1];
                            let _e482 = columns_v14[2];
                            put(m, 3u32.wrapping_mul(_e473).wrapping_add(_e475), _e478, _e480, _e482);
                        }
                    }
                    let _e483 = pair_v11;
                    pair_v11 = _e483.wrapping_add(1u32);
                }
            }
        }
        let _e486 = e_v0;
        e_v0 = _e486.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let membranes = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut blocks = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        membranes: &membranes,
        positions: &positions,
        start: &start,
        blocks: &mut blocks,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
