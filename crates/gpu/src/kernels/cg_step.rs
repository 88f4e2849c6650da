// Written from `shader/linear/cg_step.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "cg_step",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/two_sums.wgsl"),
        include_str!("../../shader/shared/rigid.wgsl"),
        include_str!("../../shader/linear/cg_step.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const THREADS: u32 = 256u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub patches: u32,
    pub grouped: u32,
    pub start: u32,
    pub workgroups: u32,
    pub curvatures: u32,
    pub norms: u32,
    pub present: u32,
    pub next: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::cg_step::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct PatchSlot {
    pub node: u32,
    pub factors: [f32; 6],
    pub arm: [f32; 3],
    pub link: [f32; 2],
}

impl PatchSlot {
    const ZERO: Self = Self {
        node: 0u32,
        factors: [0.0f32; 6],
        arm: [0.0f32; 3],
        link: [0.0f32; 2],
    };
}

impl Stored for PatchSlot {
    const WORDS: usize = 12;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            node: <u32>::load(words, at + 0),
            factors: <[f32; 6]>::load(words, at + 1),
            arm: <[f32; 3]>::load(words, at + 7),
            link: <[f32; 2]>::load(words, at + 10),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.node.store(words, at + 0);
        self.factors.store(words, at + 1);
        self.arm.store(words, at + 7);
        self.link.store(words, at + 10);
    }
}

struct Memory<'a> {
    params: Params,
    slots: &'a [u32],
    domains: &'a [u32],
    direction: &'a [u32],
    image: &'a mut [u32],
    solution: &'a mut [u32],
    forces: &'a mut [u32],
    sums: &'a mut [u32],
    progress: &'a mut [u32],
    shared_sums: [f32; 256],
    shared_pairs: [[f32; 2]; 256],
    child_links: [f32; 128],
    group_forces: [f32; 192],
    decision: u32,
    slot_forces: [f32; 1536],
    motions: [f32; 192],
}

pub fn sum_of_threads(m: &mut Memory<'_>, thread_a0: [u32; 256], value_a1: [f32; 256]) -> [f32; 256] {
    let mut reach_v0: u32 = 128u32;
    for t in 0..256 {
        m.shared_sums[thread_a0[t] as usize] = value_a1[t];
    }
    'l0: loop {
        'c0: {
            let _e6 = reach_v0;
            if (_e6 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = reach_v0;
                for t in 0..256 {
                    if (thread_a0[t] < _e9) {
                        let _e13 = m.shared_sums[thread_a0[t] as usize];
                        let _e15 = reach_v0;
                        let _e18 = m.shared_sums[thread_a0[t].wrapping_add(_e15) as usize];
                        m.shared_sums[thread_a0[t] as usize] = (_e13 + _e18);
                    }
                }
            }
        }
        let _e20 = reach_v0;
        reach_v0 = (_e20 / 2u32);
    }
    let _e25 = { let t = 0; m.shared_sums[0] };
    return std::array::from_fn::<_, 256, _>(|t| _e25);
}

pub fn sum_of_own_parts(m: &mut Memory<'_>, thread_a0: u32, first_a1: u32, count_a2: u32) -> f32 {
    let mut sum_v0: f32 = 0.0f32;
    let mut k_v1: u32;
    k_v1 = thread_a0;
    'l0: loop {
        'c0: {
            let _e6 = k_v1;
            if (_e6 < count_a2) {
            } else {
                break 'l0;
            }
            {
                let _e8 = sum_v0;
                let _e10 = k_v1;
                let _e13 = <f32>::load(m.sums, 1 * (first_a1.wrapping_add(_e10) as usize));
                sum_v0 = (_e8 + _e13);
            }
        }
        let _e15 = k_v1;
        k_v1 = _e15.wrapping_add(256u32);
    }
    let _e18 = sum_v0;
    return _e18;
}

pub fn two_sums_of_parts(m: &mut Memory<'_>, thread_a0: [u32; 256], firsts_a1: [[u32; 2]; 256], counts_a2: [[u32; 2]; 256]) -> [[f32; 2]; 256] {
    let mut reach_v0: u32 = 128u32;
    for t in 0..256 {
        let a_e5 = sum_of_own_parts(m, thread_a0[t], (firsts_a1[t])[0], (counts_a2[t])[0]);
        let _e10 = sum_of_own_parts(m, thread_a0[t], (firsts_a1[t])[1], (counts_a2[t])[1]);
        m.shared_pairs[thread_a0[t] as usize] = [a_e5, _e10];
    }
    'l0: loop {
        'c0: {
            let _e14 = reach_v0;
            if (_e14 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e17 = reach_v0;
                for t in 0..256 {
                    if (thread_a0[t] < _e17) {
                        let _e21 = m.shared_pairs[thread_a0[t] as usize];
                        let _e23 = reach_v0;
                        let _e26 = m.shared_pairs[thread_a0[t].wrapping_add(_e23) as usize];
                        m.shared_pairs[thread_a0[t] as usize] = zip(_e21, _e26, |x, y| (x + y));
                    }
                }
            }
        }
        let _e28 = reach_v0;
        reach_v0 = (_e28 / 2u32);
    }
    let _e33 = { let t = 0; m.shared_pairs[0] };
    return std::array::from_fn::<_, 256, _>(|t| _e33);
}

pub fn force_on_parent(m: &mut Memory<'_>, q_a0: u32, c_a1: u32) -> f32 {
    let mut sum_v0: f32 = 0.0f32;
    let mut m_v1: u32 = 0u32;
    let forces_e3 = 48u32.wrapping_mul(q_a0);
    let links_e5 = 32u32.wrapping_mul(q_a0);
    'l0: loop {
        'c0: {
            let _e10 = m_v1;
            if (_e10 < 8u32) {
            } else {
                break 'l0;
            }
            {
                if (c_a1 < 3u32) {
                    let _e15 = sum_v0;
                    let _e18 = m_v1;
                    let _e23 = m.group_forces[forces_e3.wrapping_add(6u32.wrapping_mul(_e18)).wrapping_add(c_a1) as usize];
                    sum_v0 = (_e15 + _e23);
                } else {
                    let a_e28 = (c_a1.wrapping_sub(2u32) % 3u32);
                    let b_e32 = (c_a1.wrapping_sub(1u32) % 3u32);
                    let _e33 = sum_v0;
                    let _e36 = m_v1;
                    let _e42 = m.child_links[links_e5.wrapping_add(4u32.wrapping_mul(_e36)).wrapping_add(3u32) as usize];
                    let _e45 = m_v1;
                    let _e50 = m.group_forces[forces_e3.wrapping_add(6u32.wrapping_mul(_e45)).wrapping_add(c_a1) as usize];
                    let _e54 = m_v1;
                    let _e59 = m.child_links[links_e5.wrapping_add(4u32.wrapping_mul(_e54)).wrapping_add(a_e28) as usize];
                    let _e62 = m_v1;
                    let _e67 = m.group_forces[forces_e3.wrapping_add(6u32.wrapping_mul(_e62)).wrapping_add(b_e32) as usize];
                    let _e72 = m_v1;
                    let _e77 = m.child_links[links_e5.wrapping_add(4u32.wrapping_mul(_e72)).wrapping_add(b_e32) as usize];
                    let _e80 = m_v1;
                    let _e85 = m.group_forces[forces_e3.wrapping_add(6u32.wrapping_mul(_e80)).wrapping_add(a_e28) as usize];
                    sum_v0 = (_e33 + (((_e42 * _e50) + (_e59 * _e67)) - (_e77 * _e85)));
                }
            }
        }
        let _e89 = m_v1;
        m_v1 = _e89.wrapping_add(1u32);
    }
    let _e92 = sum_v0;
    return _e92;
}

pub fn is_positive(number_a0: f32) -> bool {
    let mut local_v0: bool;
    if (number_a0 > 0.0f32) {
        local_v0 = ((number_a0.to_bits() & 2139095040u32) != 2139095040u32);
    } else {
        local_v0 = false;
    }
    let _e11 = local_v0;
    return _e11;
}

pub fn solve(slot_a0: PatchSlot, r_a1: [f32; 3]) -> [f32; 3] {
    let f_e2 = (slot_a0).factors;
    let y_e7 = ((r_a1)[1] - ((f_e2)[0] * (r_a1)[0]));
    let z_e17 = ((f_e2)[5] * (((r_a1)[2] - ((f_e2)[1] * (r_a1)[0])) - ((f_e2)[2] * y_e7)));
    let y_solved_e22 = (((f_e2)[4] * y_e7) - ((f_e2)[2] * z_e17));
    let _e31 = ((((f_e2)[3] * (r_a1)[0]) - ((f_e2)[0] * y_solved_e22)) - ((f_e2)[1] * z_e17));
    return [_e31, y_solved_e22, z_e17];
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut step_v0: [f32; 256] = [0.0f32; 256];
    let mut norm_v1: [f32; 256] = [0.0f32; 256];
    let mut curvature_v2: [f32; 256] = [1.0f32; 256];
    let mut squares_v7: [f32; 256] = [0.0f32; 256];
    let mut first_v8: u32 = 0u32;
    let mut slot_v9: [PatchSlot; 256] = [PatchSlot::ZERO; 256];
    let mut r_v10: [[f32; 3]; 256] = [[0.0f32; 3]; 256];
    let mut z_v11: [[f32; 3]; 256] = [[0.0f32; 3]; 256];
    let mut t_e2: [u32; 256] = [0u32; 256];
    let mut both_e26: [[f32; 2]; 256] = [[0.0f32; 2]; 256];
    let mut q_e104: [u32; 256] = [0u32; 256];
    let mut slot_index_e106: [u32; 256] = [0u32; 256];
    let mut k_e119: [u32; 256] = [0u32; 256];
    let mut i_e135: [u32; 256] = [0u32; 256];
    let mut is_grouped_e206: [bool; 256] = [false; 256];
    let mut arm_e216: [[f32; 3]; 256] = [[0.0f32; 3]; 256];
    let mut at_e282: [u32; 256] = [0u32; 256];
    let mut _e424: [f32; 256] = [0.0f32; 256];
    let mut sum_e425: [f32; 256] = [0.0f32; 256];
    let _e11 = m.params.start;
    for t in 0..256 {
        t_e2[t] = ([t as u32, 0, 0])[0];
    }
    if (_e11 == 0u32) {
        let _e16 = m.params.present;
        let _e21 = m.params.norms;
        let _e24 = m.params.curvatures;
        both_e26 = two_sums_of_parts(m, std::array::from_fn::<_, 256, _>(|t| t_e2[t]), std::array::from_fn::<_, 256, _>(|t| [_e16, 0u32]), std::array::from_fn::<_, 256, _>(|t| [_e21, _e24]));
        for t in 0..256 {
            norm_v1[t] = (both_e26[t])[0];
            curvature_v2[t] = (both_e26[t])[1];
        }
    }
    for t in 0..256 {
        if (t_e2[t] == 0u32) {
            let _e31 = norm_v1[t];
            let _e34 = <f32>::load(m.progress, 2);
            let mut local_v3: bool;
            if (_e31 > _e34) {
                let _e38 = norm_v1[t];
                let _e39 = is_positive(_e38);
                local_v3 = _e39;
            } else {
                local_v3 = false;
            }
            let _e41 = local_v3;
            let mut local_v4: bool;
            if _e41 {
                let _e44 = curvature_v2[t];
                let _e45 = is_positive(_e44);
                local_v4 = _e45;
            } else {
                local_v4 = false;
            }
            let goes_on_e47 = local_v4;
            let _e50 = <u32>::load(m.progress, 0);
            let is_moving_e52 = (_e50 == 1u32);
            let mut local_v5: bool;
            if is_moving_e52 {
                let mut local_v6: bool;
                if (!goes_on_e47) {
                    let _e63 = m.params.start;
                    local_v6 = (_e63 == 1u32);
                } else {
                    local_v6 = true;
                }
                let _e67 = local_v6;
                local_v5 = _e67;
            } else {
                local_v5 = false;
            }
            let _e69 = local_v5;
            m.decision = (if _e69 { 1u32 } else { 0u32 });
        }
    }
    let _e72 = { let t = 0; m.decision };
    if (_e72 == 0u32) {
        for t in 0..256 {
            if (t_e2[t] == 0u32) {
                let _e80 = m.params.next;
                let _e87 = m.params.present;
                let _e91 = <f32>::load(m.sums, 1 * (_e87.wrapping_add(([group, 0, 0])[0]) as usize));
                Stored::store(_e91, m.sums, 1 * (_e80.wrapping_add(([group, 0, 0])[0]) as usize));
                Stored::store(0u32, m.progress, 0);
            }
        }
        return;
    }
    let _e97 = m.params.start;
    for t in 0..256 {
        if (_e97 == 0u32) {
            let _e100 = norm_v1[t];
            let _e101 = curvature_v2[t];
            step_v0[t] = (_e100 / _e101);
        }
        q_e104[t] = (t_e2[t] / 64u32);
        slot_index_e106[t] = (t_e2[t] % 64u32);
    }
    first_v8 = 4u32.wrapping_mul(([group, 0, 0])[0]);
    'l0: loop {
        'c0: {
            let _e113 = first_v8;
            let _e116 = m.params.patches;
            if (_e113 < _e116) {
            } else {
                break 'l0;
            }
            {
                let _e118 = first_v8;
                let _e126 = m.params.patches;
                let _e198 = first_v8;
                let _e201 = m.params.grouped;
                for t in 0..256 {
                    k_e119[t] = _e118.wrapping_add(q_e104[t]);
                    slot_v9[t] = PatchSlot::ZERO;
                    slot_v9[t].node = 4294967295u32;
                    if (k_e119[t] < _e126) {
                        let _e133 = <PatchSlot>::load(m.slots, 12 * (64u32.wrapping_mul(k_e119[t]).wrapping_add(slot_index_e106[t]) as usize));
                        slot_v9[t] = _e133;
                    }
                    i_e135[t] = slot_v9[t].node;
                    r_v10[t] = [0.0f32; 3];
                    if (i_e135[t] != 4294967295u32) {
                        let _e143 = <[f32; 4]>::load(m.direction, 4 * (i_e135[t] as usize));
                        let p_e144 = swizzle(_e143, [0, 1, 2]);
                        let _e147 = m.params.start;
                        if (_e147 == 1u32) {
                            r_v10[t] = p_e144;
                            Stored::store([0.0f32; 4], m.solution, 4 * (i_e135[t] as usize));
                        } else {
                            let _e157 = m.params.nodes;
                            let _e160 = <[f32; 4]>::load(m.solution, 4 * (_e157.wrapping_add(i_e135[t]) as usize));
                            let _e162 = step_v0[t];
                            let _e165 = <[f32; 4]>::load(m.image, 4 * (i_e135[t] as usize));
                            r_v10[t] = zip(swizzle(_e160, [0, 1, 2]), swizzle(_e165, [0, 1, 2]).map(|x| (_e162 * x)), |x, y| (x - y));
                            let _e173 = <[f32; 4]>::load(m.solution, 4 * (i_e135[t] as usize));
                            let _e175 = step_v0[t];
                            let _e177 = zip(swizzle(_e173, [0, 1, 2]), p_e144.map(|x| (_e175 * x)), |x, y| (x + y));
                            Stored::store([(_e177)[0], (_e177)[1], (_e177)[2], 0.0f32], m.solution, 4 * (i_e135[t] as usize));
                        }
                        let _e183 = m.params.nodes;
                        let _e186 = r_v10[t];
                        Stored::store([(_e186)[0], (_e186)[1], (_e186)[2], 0.0f32], m.solution, 4 * (_e183.wrapping_add(i_e135[t]) as usize));
                    }
                    let _e189 = slot_v9[t];
                    let _e190 = r_v10[t];
                    let _e191 = solve(_e189, _e190);
                    z_v11[t] = _e191;
                    let _e193 = squares_v7[t];
                    let _e194 = r_v10[t];
                    let _e195 = z_v11[t];
                    squares_v7[t] = (_e193 + dot(_e194, _e195));
                }
                if (_e198 < _e201) {
                    let _e205 = m.params.grouped;
                    for t in 0..256 {
                        is_grouped_e206[t] = (k_e119[t] < _e205);
                        let _e209 = slot_v9[t].arm[0];
                        let _e212 = slot_v9[t].arm[1];
                        let _e215 = slot_v9[t].arm[2];
                        arm_e216[t] = [_e209, _e212, _e215];
                        let _e217 = r_v10[t];
                        let moment_e218 = cross(arm_e216[t], _e217);
                        if ((t_e2[t] % 8u32) < 2u32) {
                            let _e236 = slot_v9[t].link[0];
                            m.child_links[4u32.wrapping_mul((t_e2[t] / 8u32)).wrapping_add(2u32.wrapping_mul((t_e2[t] % 8u32))) as usize] = _e236;
                            let _e252 = slot_v9[t].link[1];
                            m.child_links[4u32.wrapping_mul((t_e2[t] / 8u32)).wrapping_add(2u32.wrapping_mul((t_e2[t] % 8u32))).wrapping_add(1u32) as usize] = _e252;
                        }
                        let mut c_v12: u32;
                        c_v12 = 0u32;
                        'l1: loop {
                            'c1: {
                                let _e255 = c_v12;
                                if (_e255 < 3u32) {
                                } else {
                                    break 'l1;
                                }
                                {
                                    let _e261 = c_v12;
                                    let _e264 = c_v12;
                                    let _e266 = r_v10[t][_e264 as usize];
                                    m.slot_forces[6u32.wrapping_mul(t_e2[t]).wrapping_add(_e261) as usize] = _e266;
                                    let _e272 = c_v12;
                                    let _e275 = c_v12;
                                    m.slot_forces[6u32.wrapping_mul(t_e2[t]).wrapping_add(3u32).wrapping_add(_e272) as usize] = (moment_e218)[_e275 as usize];
                                }
                            }
                            let _e277 = c_v12;
                            c_v12 = _e277.wrapping_add(1u32);
                        }
                    }
                    for t in 0..256 {
                        at_e282[t] = 48u32.wrapping_mul(q_e104[t]).wrapping_add(slot_index_e106[t]);
                        if (slot_index_e106[t] < 48u32) {
                            let mut f_v13: f32;
                            f_v13 = 0.0f32;
                            let mut m_v14: u32;
                            m_v14 = 0u32;
                            'l2: loop {
                                'c2: {
                                    let _e289 = m_v14;
                                    if (_e289 < 8u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e292 = f_v13;
                                        let _e299 = m_v14;
                                        let _e306 = m.slot_forces[6u32.wrapping_mul(8u32.wrapping_mul((at_e282[t] / 6u32)).wrapping_add(_e299)).wrapping_add((at_e282[t] % 6u32)) as usize];
                                        f_v13 = (_e292 + _e306);
                                    }
                                }
                                let _e308 = m_v14;
                                m_v14 = _e308.wrapping_add(1u32);
                            }
                            let _e313 = f_v13;
                            m.group_forces[at_e282[t] as usize] = _e313;
                        }
                    }
                    for t in 0..256 {
                        let mut local_v15: bool;
                        if (slot_index_e106[t] < 48u32) {
                            local_v15 = is_grouped_e206[t];
                        } else {
                            local_v15 = false;
                        }
                        let _e319 = local_v15;
                        if _e319 {
                            let mut motion_v16: f32;
                            motion_v16 = 0.0f32;
                            let mut m_v17: u32;
                            m_v17 = 0u32;
                            'l3: loop {
                                'c3: {
                                    let _e324 = m_v17;
                                    if (_e324 < 48u32) {
                                    } else {
                                        break 'l3;
                                    }
                                    {
                                        let _e327 = motion_v16;
                                        let _e332 = m_v17;
                                        let _e337 = <f32>::load(m.domains, 1 * (2304u32.wrapping_mul(k_e119[t]).wrapping_add(48u32.wrapping_mul(_e332)).wrapping_add(slot_index_e106[t]) as usize));
                                        let _e341 = m_v17;
                                        let _e344 = m.group_forces[48u32.wrapping_mul(q_e104[t]).wrapping_add(_e341) as usize];
                                        motion_v16 = (_e327 + (_e337 * _e344));
                                    }
                                }
                                let _e347 = m_v17;
                                m_v17 = _e347.wrapping_add(1u32);
                            }
                            let _e352 = motion_v16;
                            m.motions[at_e282[t] as usize] = _e352;
                            let _e353 = squares_v7[t];
                            let _e354 = motion_v16;
                            let _e357 = m.group_forces[at_e282[t] as usize];
                            squares_v7[t] = (_e353 + (_e354 * _e357));
                        }
                        let mut local_v18: bool;
                        if (slot_index_e106[t] < 6u32) {
                            local_v18 = is_grouped_e206[t];
                        } else {
                            local_v18 = false;
                        }
                        let _e365 = local_v18;
                        if _e365 {
                            let _e371 = force_on_parent(m, q_e104[t], slot_index_e106[t]);
                            Stored::store(_e371, m.forces, 1 * (6u32.wrapping_mul(k_e119[t]).wrapping_add(slot_index_e106[t]) as usize));
                        }
                    }
                    for t in 0..256 {
                        if is_grouped_e206[t] {
                            let g_e375 = 6u32.wrapping_mul((t_e2[t] / 8u32));
                            let _e380 = m.motions[g_e375.wrapping_add(3u32) as usize];
                            let _e385 = m.motions[g_e375.wrapping_add(4u32) as usize];
                            let _e390 = m.motions[g_e375.wrapping_add(5u32) as usize];
                            let spin_e391 = [_e380, _e385, _e390];
                            let _e392 = z_v11[t];
                            let _e395 = m.motions[g_e375 as usize];
                            let _e400 = m.motions[g_e375.wrapping_add(1u32) as usize];
                            let _e405 = m.motions[g_e375.wrapping_add(2u32) as usize];
                            z_v11[t] = zip(_e392, zip([_e395, _e400, _e405], cross(spin_e391, arm_e216[t]), |x, y| (x + y)), |x, y| (x + y));
                        }
                    }
                }
                for t in 0..256 {
                    if (i_e135[t] != 4294967295u32) {
                        let _e414 = z_v11[t];
                        Stored::store([(_e414)[0], (_e414)[1], (_e414)[2], 0.0f32], m.image, 4 * (i_e135[t] as usize));
                    }
                }
            }
        }
        let _e417 = first_v8;
        let _e421 = m.params.workgroups;
        first_v8 = _e417.wrapping_add(4u32.wrapping_mul(_e421));
    }
    for t in 0..256 {
        _e424[t] = squares_v7[t];
    }
    sum_e425 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| t_e2[t]), std::array::from_fn::<_, 256, _>(|t| _e424[t]));
    for t in 0..256 {
        if (t_e2[t] == 0u32) {
            let _e431 = m.params.next;
            Stored::store(sum_e425[t], m.sums, 1 * (_e431.wrapping_add(([group, 0, 0])[0]) as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let slots = bound.read(0);
    let domains = bound.read(1);
    let direction = bound.read(2);
    let mut image = bound.write(3);
    let mut solution = bound.write(4);
    let mut forces = bound.write(5);
    let mut sums = bound.write(6);
    let mut progress = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        slots: &slots,
        domains: &domains,
        direction: &direction,
        image: &mut image,
        solution: &mut solution,
        forces: &mut forces,
        sums: &mut sums,
        progress: &mut progress,
        shared_sums: [0.0f32; 256],
        shared_pairs: [[0.0f32; 2]; 256],
        child_links: [0.0f32; 128],
        group_forces: [0.0f32; 192],
        decision: 0u32,
        slot_forces: [0.0f32; 1536],
        motions: [0.0f32; 192],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        m.shared_pairs = [[0.0f32; 2]; 256];
        m.child_links = [0.0f32; 128];
        m.group_forces = [0.0f32; 192];
        m.decision = 0u32;
        m.slot_forces = [0.0f32; 1536];
        m.motions = [0.0f32; 192];
        main(&mut m, group as u32);
    }
}
}
