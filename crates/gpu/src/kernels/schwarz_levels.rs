// Written from `shader/linear/schwarz_levels.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "schwarz_levels",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/rigid.wgsl"),
        include_str!("../../shader/linear/schwarz_levels.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const THREADS: u32 = 256u32;
pub const LANES: u32 = 32u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub groups: [u32; 4],
    pub firsts: [u32; 4],
    pub first_domains: [u32; 4],
    pub domains: u32,
    pub workgroups: u32,
    pub present: u32,
    pub next: u32,
    pub parents: u32,
    pub padding: [u32; 3],
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::schwarz_levels::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Wrench {
    pub force: [f32; 3],
    pub torque: [f32; 3],
}

impl Wrench {
    const ZERO: Self = Self {
        force: [0.0f32; 3],
        torque: [0.0f32; 3],
    };
}

impl Stored for Wrench {
    const WORDS: usize = 8;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            force: <[f32; 3]>::load(words, at + 0),
            torque: <[f32; 3]>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.force.store(words, at + 0);
        self.torque.store(words, at + 4);
    }
}

struct Memory<'a> {
    params: Params,
    coarse: &'a [u32],
    links: &'a [u32],
    forces: &'a mut [u32],
    group_motions: &'a mut [u32],
    sums: &'a mut [u32],
    progress: &'a mut [u32],
    shared_sums: [f32; 256],
    child_links: [f32; 128],
    group_forces: [f32; 48],
    is_moving: u32,
    lane_forces: [[f32; 6]; 256],
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

pub fn rise_of(m: &mut Memory<'_>, domain_a0: u32) -> u32 {
    let _e3 = m.params.first_domains;
    let firsts_e4 = swizzle(_e3, [1, 2, 3]);
    let above_e11 = select(zip([domain_a0; 3], firsts_e4, |x, y| (x >= y)), [1u32; 3], [0u32; 3]);
    return (above_e11)[0].wrapping_add((above_e11)[1]).wrapping_add((above_e11)[2]);
}

pub fn first_parent(m: &mut Memory<'_>, rise_a0: u32) -> u32 {
    let _e8 = m.params.firsts[(rise_a0.wrapping_add(1u32) % 4u32) as usize];
    let _e11 = m.params.parents;
    return (if (rise_a0 == 3u32) { _e11 } else { _e8 });
}

pub fn lanes_of(rise_a0: u32) -> u32 {
    return (if (rise_a0 == 3u32) { 32u32 } else { 1u32.wrapping_shl(3u32.wrapping_mul(rise_a0)).min(8u32) });
}

pub fn force_on(m: &mut Memory<'_>, part_a0: u32) -> Wrench {
    let _e5 = m.params.firsts[0];
    let at_e7 = 6u32.wrapping_mul(_e5.wrapping_add(part_a0));
    let _e10 = <f32>::load(m.forces, 1 * (at_e7 as usize));
    let _e15 = <f32>::load(m.forces, 1 * (at_e7.wrapping_add(1u32) as usize));
    let _e20 = <f32>::load(m.forces, 1 * (at_e7.wrapping_add(2u32) as usize));
    let _e21 = [_e10, _e15, _e20];
    let _e26 = <f32>::load(m.forces, 1 * (at_e7.wrapping_add(3u32) as usize));
    let _e31 = <f32>::load(m.forces, 1 * (at_e7.wrapping_add(4u32) as usize));
    let _e36 = <f32>::load(m.forces, 1 * (at_e7.wrapping_add(5u32) as usize));
    let _e37 = [_e26, _e31, _e36];
    return Wrench { force: _e21, torque: _e37 };
}

pub fn lifted(m: &mut Memory<'_>, on_group_a0: Wrench, level_a1: u32, group_a2: u32) -> [f32; 3] {
    let _e8 = m.params.first_domains[level_a1 as usize];
    let link_e12 = <[f32; 4]>::load(m.links, 4 * (8u32.wrapping_mul(_e8).wrapping_add(group_a2) as usize));
    return zip((on_group_a0).torque.map(|x| ((link_e12)[3] * x)), cross(swizzle(link_e12, [0, 1, 2]), (on_group_a0).force), |x, y| (x + y));
}

pub fn sum_of_lane(m: &mut Memory<'_>, group_a0: u32, rise_a1: u32, lane_a2: u32) -> [f32; 6] {
    let mut sum_v0: Wrench = Wrench::ZERO;
    if (rise_a1 < 2u32) {
        let part_e10 = group_a0.wrapping_shl(3u32.wrapping_mul(rise_a1)).wrapping_add(lane_a2);
        let _e11 = lanes_of(rise_a1);
        let mut local_v1: bool;
        if (lane_a2 < _e11) {
            let _e18 = m.params.groups[0];
            local_v1 = (part_e10 < _e18);
        } else {
            local_v1 = false;
        }
        let _e21 = local_v1;
        if _e21 {
            let _e22 = force_on(m, part_e10);
            sum_v0 = _e22;
            if (rise_a1 == 1u32) {
                let _e26 = sum_v0;
                let _e28 = lifted(m, _e26, 0u32, part_e10);
                sum_v0.torque = _e28;
            }
        }
    } else {
        let shift_e32 = 3u32.wrapping_mul(rise_a1.wrapping_sub(1u32));
        let _e39 = m.params.groups[0];
        let end_e44 = group_a0.wrapping_add(1u32).wrapping_shl(shift_e32).min((_e39.wrapping_add(7u32) / 8u32));
        let mut eight_v2: u32;
        eight_v2 = group_a0.wrapping_shl(shift_e32).wrapping_add(lane_a2);
        'l0: loop {
            'c0: {
                let _e48 = eight_v2;
                if (_e48 < end_e44) {
                } else {
                    break 'l0;
                }
                {
                    let mut of_eight_v3: Wrench;
                    of_eight_v3 = Wrench::ZERO;
                    let mut m_v4: u32;
                    m_v4 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e54 = m_v4;
                            if (_e54 < 8u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let _e58 = eight_v2;
                                let _e60 = m_v4;
                                let part_e61 = 8u32.wrapping_mul(_e58).wrapping_add(_e60);
                                let _e65 = m.params.groups[0];
                                if (part_e61 < _e65) {
                                    let own_e67 = force_on(m, part_e61);
                                    let _e69 = of_eight_v3.force;
                                    of_eight_v3.force = zip(_e69, (own_e67).force, |x, y| (x + y));
                                    let _e73 = of_eight_v3.torque;
                                    let _e75 = lifted(m, own_e67, 0u32, part_e61);
                                    of_eight_v3.torque = zip(_e73, _e75, |x, y| (x + y));
                                }
                            }
                        }
                        let _e77 = m_v4;
                        m_v4 = _e77.wrapping_add(1u32);
                    }
                    let mut level_v5: u32;
                    level_v5 = 1u32;
                    'l2: loop {
                        'c2: {
                            let _e82 = level_v5;
                            if (_e82 < rise_a1) {
                            } else {
                                break 'l2;
                            }
                            {
                                let _e85 = of_eight_v3;
                                let _e86 = level_v5;
                                let _e87 = eight_v2;
                                let _e89 = level_v5;
                                let _e94 = lifted(m, _e85, _e86, _e87.wrapping_shr(3u32.wrapping_mul(_e89.wrapping_sub(1u32))));
                                of_eight_v3.torque = _e94;
                            }
                        }
                        let _e95 = level_v5;
                        level_v5 = _e95.wrapping_add(1u32);
                    }
                    let _e99 = sum_v0.force;
                    let _e101 = of_eight_v3.force;
                    sum_v0.force = zip(_e99, _e101, |x, y| (x + y));
                    let _e104 = sum_v0.torque;
                    let _e106 = of_eight_v3.torque;
                    sum_v0.torque = zip(_e104, _e106, |x, y| (x + y));
                }
            }
            let _e108 = eight_v2;
            eight_v2 = _e108.wrapping_add(32u32);
        }
    }
    let force_e112 = sum_v0.force;
    let torque_e114 = sum_v0.torque;
    let _e115 = (force_e112)[0];
    let _e116 = (force_e112)[1];
    let _e117 = (force_e112)[2];
    let _e118 = (torque_e114)[0];
    let _e119 = (torque_e114)[1];
    let _e120 = (torque_e114)[2];
    return [_e115, _e116, _e117, _e118, _e119, _e120];
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut squares_v0: [f32; 256] = [0.0f32; 256];
    let mut k_v1: u32 = 0u32;
    let mut t_e2: [u32; 256] = [0u32; 256];
    let mut rise_e45: [u32; 256] = [0u32; 256];
    let mut parent_e50: [u32; 256] = [0u32; 256];
    let mut _e193: [f32; 256] = [0.0f32; 256];
    let mut sum_e194: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        t_e2[t] = ([t as u32, 0, 0])[0];
        if (t_e2[t] == 0u32) {
            let _e8 = <u32>::load(m.progress, 0);
            m.is_moving = _e8;
        }
    }
    let _e10 = { let t = 0; m.is_moving };
    if (_e10 == 0u32) {
        for t in 0..256 {
            if (t_e2[t] == 0u32) {
                let _e18 = m.params.next;
                let _e25 = m.params.present;
                let _e29 = <f32>::load(m.sums, 1 * (_e25.wrapping_add(([group, 0, 0])[0]) as usize));
                Stored::store(_e29, m.sums, 1 * (_e18.wrapping_add(([group, 0, 0])[0]) as usize));
            }
        }
        return;
    }
    k_v1 = ([group, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e34 = k_v1;
            let _e37 = m.params.domains;
            if (_e34 < _e37) {
            } else {
                break 'l0;
            }
            {
                let _e42 = m.params.first_domains[0];
                let _e43 = k_v1;
                let domain_e44 = _e42.wrapping_add(_e43);
                for t in 0..256 {
                    rise_e45[t] = rise_of(m, domain_e44);
                    let _e49 = m.params.first_domains[rise_e45[t] as usize];
                    parent_e50[t] = domain_e44.wrapping_sub(_e49);
                }
                for t in 0..256 {
                    let _e60 = sum_of_lane(m, 8u32.wrapping_mul(parent_e50[t]).wrapping_add((t_e2[t] / 32u32)), rise_e45[t], (t_e2[t] % 32u32));
                    m.lane_forces[t_e2[t] as usize] = _e60;
                    if (t_e2[t] < 8u32) {
                        let link_e68 = <[f32; 4]>::load(m.links, 4 * (8u32.wrapping_mul(domain_e44).wrapping_add(t_e2[t]) as usize));
                        let mut c_v2: u32;
                        c_v2 = 0u32;
                        'l1: loop {
                            'c1: {
                                let _e71 = c_v2;
                                if (_e71 < 4u32) {
                                } else {
                                    break 'l1;
                                }
                                {
                                    let _e77 = c_v2;
                                    let _e80 = c_v2;
                                    m.child_links[4u32.wrapping_mul(t_e2[t]).wrapping_add(_e77) as usize] = (link_e68)[_e80 as usize];
                                }
                            }
                            let _e82 = c_v2;
                            c_v2 = _e82.wrapping_add(1u32);
                        }
                    }
                }
                for t in 0..256 {
                    if (t_e2[t] < 48u32) {
                        let mut sum_v3: f32;
                        sum_v3 = 0.0f32;
                        let mut lane_v4: u32;
                        lane_v4 = 0u32;
                        'l2: loop {
                            'c2: {
                                let _e91 = lane_v4;
                                let _e92 = lanes_of(rise_e45[t]);
                                if (_e91 < _e92) {
                                } else {
                                    break 'l2;
                                }
                                {
                                    let _e94 = sum_v3;
                                    let _e100 = lane_v4;
                                    let _e106 = m.lane_forces[32u32.wrapping_mul((t_e2[t] / 6u32)).wrapping_add(_e100) as usize][(t_e2[t] % 6u32) as usize];
                                    sum_v3 = (_e94 + _e106);
                                }
                            }
                            let _e108 = lane_v4;
                            lane_v4 = _e108.wrapping_add(1u32);
                        }
                        let _e113 = sum_v3;
                        m.group_forces[t_e2[t] as usize] = _e113;
                    }
                }
                for t in 0..256 {
                    let child_e118 = 8u32.wrapping_mul(parent_e50[t]).wrapping_add((t_e2[t] / 6u32));
                    let mut local_v5: bool;
                    if (t_e2[t] < 48u32) {
                        let _e126 = m.params.groups[rise_e45[t] as usize];
                        local_v5 = (child_e118 < _e126);
                    } else {
                        local_v5 = false;
                    }
                    let _e129 = local_v5;
                    if _e129 {
                        let mut motion_v6: f32;
                        motion_v6 = 0.0f32;
                        let mut m_v7: u32;
                        m_v7 = 0u32;
                        'l3: loop {
                            'c3: {
                                let _e134 = m_v7;
                                if (_e134 < 48u32) {
                                } else {
                                    break 'l3;
                                }
                                {
                                    let _e137 = motion_v6;
                                    let _e142 = m_v7;
                                    let _e147 = <f32>::load(m.coarse, 1 * (2304u32.wrapping_mul(domain_e44).wrapping_add(48u32.wrapping_mul(_e142)).wrapping_add(t_e2[t]) as usize));
                                    let _e149 = m_v7;
                                    let _e151 = m.group_forces[_e149 as usize];
                                    motion_v6 = (_e137 + (_e147 * _e151));
                                }
                            }
                            let _e154 = m_v7;
                            m_v7 = _e154.wrapping_add(1u32);
                        }
                        let _e162 = m.params.firsts[rise_e45[t] as usize];
                        let _e169 = motion_v6;
                        Stored::store(_e169, m.group_motions, 1 * (6u32.wrapping_mul(_e162.wrapping_add(child_e118)).wrapping_add((t_e2[t] % 6u32)) as usize));
                        let _e170 = squares_v0[t];
                        let _e171 = motion_v6;
                        let _e174 = m.group_forces[t_e2[t] as usize];
                        squares_v0[t] = (_e170 + (_e171 * _e174));
                    }
                    if (t_e2[t] < 6u32) {
                        let _e181 = first_parent(m, rise_e45[t]);
                        let _e187 = force_on_parent(m, 0u32, t_e2[t]);
                        Stored::store(_e187, m.forces, 1 * (6u32.wrapping_mul(_e181.wrapping_add(parent_e50[t])).wrapping_add(t_e2[t]) as usize));
                    }
                }
            }
        }
        let _e188 = k_v1;
        let _e191 = m.params.workgroups;
        k_v1 = _e188.wrapping_add(_e191);
    }
    for t in 0..256 {
        _e193[t] = squares_v0[t];
    }
    sum_e194 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| t_e2[t]), std::array::from_fn::<_, 256, _>(|t| _e193[t]));
    for t in 0..256 {
        if (t_e2[t] == 0u32) {
            let _e200 = m.params.next;
            Stored::store(sum_e194[t], m.sums, 1 * (_e200.wrapping_add(([group, 0, 0])[0]) as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let coarse = bound.read(0);
    let links = bound.read(1);
    let mut forces = bound.write(2);
    let mut group_motions = bound.write(3);
    let mut sums = bound.write(4);
    let mut progress = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        coarse: &coarse,
        links: &links,
        forces: &mut forces,
        group_motions: &mut group_motions,
        sums: &mut sums,
        progress: &mut progress,
        shared_sums: [0.0f32; 256],
        child_links: [0.0f32; 128],
        group_forces: [0.0f32; 48],
        is_moving: 0u32,
        lane_forces: [[0.0f32; 6]; 256],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        m.child_links = [0.0f32; 128];
        m.group_forces = [0.0f32; 48];
        m.is_moving = 0u32;
        m.lane_forces = [[0.0f32; 6]; 256];
        main(&mut m, group as u32);
    }
}
}
