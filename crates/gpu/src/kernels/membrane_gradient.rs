// Written from `shader/elements/membrane_gradient.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "membrane_gradient",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/elements.wgsl"),
        include_str!("../../shader/shared/gradients.wgsl"),
        include_str!("../../shader/shared/triangle.wgsl"),
        include_str!("../../shader/elements/membrane_gradient.wgsl"),
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct GradientParams {
    pub elements: u32,
    pub first: u32,
    pub rate: f32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::membrane_gradient::*;
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
    params: GradientParams,
    membranes: &'a [u32],
    positions: &'a [u32],
    start: &'a [u32],
    gradients: &'a mut [u32],
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

pub fn put(m: &mut Memory<'_>, entry_a0: u32, gradient_a1: [f32; 3]) {
    let _e5 = m.params.first;
    let at_e7 = 3u32.wrapping_mul(_e5.wrapping_add(entry_a0));
    Stored::store((gradient_a1)[0], m.gradients, 1 * (at_e7 as usize));
    Stored::store((gradient_a1)[1], m.gradients, 1 * (at_e7.wrapping_add(1u32) as usize));
    Stored::store((gradient_a1)[2], m.gradients, 1 * (at_e7.wrapping_add(2u32) as usize));
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
                let _e35 = strain_of(x_e33);
                let t_e38 = stress_in((m_e11).stiffness, _e35, (x_e33).c, (x_e33).s);
                let r_e39 = shares_of(x_e33);
                let _e40 = (t_e38)[0];
                let _e45 = ((2.0f32 * (t_e38)[2]) * (r_e39)[0]);
                let _e50 = ((2.0f32 * (t_e38)[2]) * (r_e39)[1]);
                let _e51 = (t_e38)[1];
                let mut p_v1: [f32; 4];
                p_v1 = [_e40, _e45, _e50, _e51];
                let mut local_v2: bool;
                if ((m_e11).damping > 0.0f32) {
                    let _e61 = m.params.rate;
                    local_v2 = (_e61 > 0.0f32);
                } else {
                    local_v2 = false;
                }
                let _e65 = local_v2;
                if _e65 {
                    let b1_e70 = moved(m, ((m_e11).nodes)[0], ((m_e11).nodes)[1]);
                    let b2_e75 = moved(m, ((m_e11).nodes)[0], ((m_e11).nodes)[2]);
                    let strain_e86 = increment(f0_e27, f1_e32, zip(b1_e70.map(|x| (x * (g_e12)[0])), b2_e75.map(|x| (x * (g_e12)[2])), |x, y| (x + y)), zip(b1_e70.map(|x| (x * (g_e12)[1])), b2_e75.map(|x| (x * (g_e12)[3])), |x, y| (x + y)));
                    let _e90 = stress_in((m_e11).stiffness, strain_e86, (x_e33).c, (x_e33).s);
                    let _e94 = m.params.rate;
                    let viscous_e96 = _e90.map(|x| (x * ((m_e11).damping * _e94)));
                    let _e97 = p_v1;
                    let _e100 = ((x_e33).s1 * (viscous_e96)[0]);
                    let _e103 = ((x_e33).s1 * (viscous_e96)[2]);
                    let _e106 = ((x_e33).s2 * (viscous_e96)[2]);
                    let _e109 = ((x_e33).s2 * (viscous_e96)[1]);
                    p_v1 = zip(_e97, [_e100, _e103, _e106, _e109], |x, y| (x + y));
                }
                let _e118 = (((x_e33).c * (g_e12)[0]) + ((x_e33).s * (g_e12)[1]));
                let _e125 = (((x_e33).c * (g_e12)[1]) - ((x_e33).s * (g_e12)[0]));
                let a_e126 = [_e118, _e125];
                let _e133 = (((x_e33).c * (g_e12)[2]) + ((x_e33).s * (g_e12)[3]));
                let _e140 = (((x_e33).c * (g_e12)[3]) - ((x_e33).s * (g_e12)[2]));
                let b_e141 = [_e133, _e140];
                let _e144 = p_v1[0];
                let _e148 = p_v1[1];
                let _e155 = p_v1[2];
                let _e159 = p_v1[3];
                let first_e166 = zip((x_e33).u1.map(|x| (x * ((_e144 * (a_e126)[0]) + (_e148 * (a_e126)[1])))), (x_e33).u2.map(|x| (x * ((_e155 * (a_e126)[0]) + (_e159 * (a_e126)[1])))), |x, y| (x + y)).map(|x| (x * (m_e11).area));
                let _e169 = p_v1[0];
                let _e173 = p_v1[1];
                let _e180 = p_v1[2];
                let _e184 = p_v1[3];
                let second_e191 = zip((x_e33).u1.map(|x| (x * ((_e169 * (b_e141)[0]) + (_e173 * (b_e141)[1])))), (x_e33).u2.map(|x| (x * ((_e180 * (b_e141)[0]) + (_e184 * (b_e141)[1])))), |x, y| (x + y)).map(|x| (x * (m_e11).area));
                let _e193 = e_v0;
                put(m, 3u32.wrapping_mul(_e193), zip(first_e166, second_e191, |x, y| (x + y)).map(|x| (-x)));
                let _e198 = e_v0;
                put(m, 3u32.wrapping_mul(_e198).wrapping_add(1u32), first_e166);
                let _e203 = e_v0;
                put(m, 3u32.wrapping_mul(_e203).wrapping_add(2u32), second_e191);
            }
        }
        let _e207 = e_v0;
        e_v0 = _e207.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let membranes = bound.read(0);
    let positions = bound.read(1);
    let start = bound.read(2);
    let mut gradients = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        membranes: &membranes,
        positions: &positions,
        start: &start,
        gradients: &mut gradients,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
