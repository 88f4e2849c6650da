// Written from `shader/linear/cg_direction.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "cg_direction",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/shared/two_sums.wgsl"),
        include_str!("../../shader/linear/cg_direction.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Write, Read, Write],
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
    pub patches: u32,
    pub grouped: u32,
    pub start: u32,
    pub workgroups: u32,
    pub levels: u32,
    pub norms: u32,
    pub present: u32,
    pub next: u32,
    pub firsts: [[u32; 4]; 3],
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::cg_direction::*;
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
    links: &'a [u32],
    group_motions: &'a [u32],
    image: &'a [u32],
    direction: &'a mut [u32],
    sums: &'a [u32],
    progress: &'a mut [u32],
    shared_sums: [f32; 256],
    shared_pairs: [[f32; 2]; 256],
    is_moving: u32,
    shifts: [[f32; 3]; 32],
    spins: [[f32; 3]; 32],
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

pub fn first_of(m: &mut Memory<'_>, level_a0: u32) -> u32 {
    let _e9 = m.params.firsts[(level_a0 / 4u32) as usize][(level_a0 % 4u32) as usize];
    return _e9;
}

pub fn find_motion(m: &mut Memory<'_>, k_a0: u32, q_a1: u32, g_a2: u32) {
    let mut shift_v0: [f32; 3] = [0.0f32; 3];
    let mut spin_v1: [f32; 3] = [0.0f32; 3];
    let _e11 = m.params.levels;
    let mut level_v2: u32;
    level_v2 = _e11;
    'l0: loop {
        'c0: {
            let _e13 = level_v2;
            if (_e13 > 0u32) {
            } else {
                break 'l0;
            }
            {
                let _e17 = level_v2;
                let index_e21 = k_a0.wrapping_shr(3u32.wrapping_mul(_e17.wrapping_sub(1u32)));
                let _e22 = level_v2;
                let _e25 = m.params.levels;
                if (_e22 < _e25) {
                    let _e27 = level_v2;
                    let _e28 = first_of(m, _e27);
                    let _e30 = first_of(m, 1u32);
                    let parent_e34 = _e28.wrapping_sub(_e30).wrapping_add(index_e21.wrapping_shr(3u32));
                    let link_e42 = <[f32; 4]>::load(m.links, 4 * (8u32.wrapping_mul(parent_e34).wrapping_add((index_e21 & 7u32)) as usize));
                    let _e43 = shift_v0;
                    let _e44 = spin_v1;
                    shift_v0 = zip(_e43, cross(_e44, swizzle(link_e42, [0, 1, 2])), |x, y| (x + y));
                    let _e48 = spin_v1;
                    spin_v1 = _e48.map(|x| (x * (link_e42)[3]));
                }
                let _e52 = level_v2;
                let _e55 = first_of(m, _e52.wrapping_sub(1u32));
                let at_e57 = 6u32.wrapping_mul(_e55.wrapping_add(index_e21));
                let _e58 = shift_v0;
                let _e61 = <f32>::load(m.group_motions, 1 * (at_e57 as usize));
                let _e66 = <f32>::load(m.group_motions, 1 * (at_e57.wrapping_add(1u32) as usize));
                let _e71 = <f32>::load(m.group_motions, 1 * (at_e57.wrapping_add(2u32) as usize));
                shift_v0 = zip(_e58, [_e61, _e66, _e71], |x, y| (x + y));
                let _e74 = spin_v1;
                let _e79 = <f32>::load(m.group_motions, 1 * (at_e57.wrapping_add(3u32) as usize));
                let _e84 = <f32>::load(m.group_motions, 1 * (at_e57.wrapping_add(4u32) as usize));
                let _e89 = <f32>::load(m.group_motions, 1 * (at_e57.wrapping_add(5u32) as usize));
                spin_v1 = zip(_e74, [_e79, _e84, _e89], |x, y| (x + y));
            }
        }
        let _e92 = level_v2;
        level_v2 = _e92.wrapping_sub(1u32);
    }
    let first_e103 = <[f32; 2]>::load(m.slots, 12 * (64u32.wrapping_mul(k_a0).wrapping_add(8u32.wrapping_mul(g_a2)) as usize) + 10);
    let second_e114 = <[f32; 2]>::load(m.slots, 12 * (64u32.wrapping_mul(k_a0).wrapping_add(8u32.wrapping_mul(g_a2)).wrapping_add(1u32) as usize) + 10);
    let _e120 = shift_v0;
    let _e121 = spin_v1;
    let _e122 = (first_e103)[0];
    let _e123 = (first_e103)[1];
    let _e124 = (second_e114)[0];
    m.shifts[8u32.wrapping_mul(q_a1).wrapping_add(g_a2) as usize] = zip(_e120, cross(_e121, [_e122, _e123, _e124]), |x, y| (x + y));
    let _e133 = spin_v1;
    m.spins[8u32.wrapping_mul(q_a1).wrapping_add(g_a2) as usize] = _e133.map(|x| (x * (second_e114)[1]));
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut ratio_v0: [f32; 256] = [0.0f32; 256];
    let mut first_v2: u32 = 0u32;
    let mut slot_v3: [PatchSlot; 256] = [PatchSlot::ZERO; 256];
    let mut z_v4: [[f32; 3]; 256] = [[0.0f32; 3]; 256];
    let mut t_e2: [u32; 256] = [0u32; 256];
    let mut both_e31: [[f32; 2]; 256] = [[0.0f32; 2]; 256];
    let mut q_e49: [u32; 256] = [0u32; 256];
    let mut k_e60: [u32; 256] = [0u32; 256];
    let mut i_e78: [u32; 256] = [0u32; 256];
    let mut _e101: [bool; 256] = [false; 256];
    let mut is_grouped_e105: [bool; 256] = [false; 256];
    for t in 0..256 {
        t_e2[t] = ([t as u32, 0, 0])[0];
        if (t_e2[t] == 0u32) {
            let _e8 = <u32>::load(m.progress, 0);
            m.is_moving = _e8;
        }
    }
    let _e10 = { let t = 0; m.is_moving };
    if (_e10 == 0u32) {
        return;
    }
    let _e17 = m.params.start;
    if (_e17 == 0u32) {
        let _e22 = m.params.present;
        let _e25 = m.params.next;
        let _e29 = m.params.norms;
        both_e31 = two_sums_of_parts(m, std::array::from_fn::<_, 256, _>(|t| t_e2[t]), std::array::from_fn::<_, 256, _>(|t| [_e22, _e25]), std::array::from_fn::<_, 256, _>(|t| [_e29; 2]));
        for t in 0..256 {
            ratio_v0[t] = ((both_e31[t])[1] / (both_e31[t])[0]);
            let mut local_v1: bool;
            if (([group, 0, 0])[0] == 0u32) {
                local_v1 = (t_e2[t] == 0u32);
            } else {
                local_v1 = false;
            }
            let _e43 = local_v1;
            if _e43 {
                { let old = <u32>::load(m.progress, 1); let new = old.wrapping_add(1u32); Stored::store(new, m.progress, 1); old };
            }
        }
    }
    for t in 0..256 {
        q_e49[t] = (t_e2[t] / 64u32);
    }
    first_v2 = 4u32.wrapping_mul(([group, 0, 0])[0]);
    'l0: loop {
        'c0: {
            let _e54 = first_v2;
            let _e57 = m.params.patches;
            if (_e54 < _e57) {
            } else {
                break 'l0;
            }
            {
                let _e59 = first_v2;
                let _e67 = m.params.patches;
                let _e88 = first_v2;
                let _e91 = m.params.grouped;
                for t in 0..256 {
                    k_e60[t] = _e59.wrapping_add(q_e49[t]);
                    slot_v3[t] = PatchSlot::ZERO;
                    slot_v3[t].node = 4294967295u32;
                    if (k_e60[t] < _e67) {
                        let _e76 = <PatchSlot>::load(m.slots, 12 * (64u32.wrapping_mul(k_e60[t]).wrapping_add((t_e2[t] % 64u32)) as usize));
                        slot_v3[t] = _e76;
                    }
                    i_e78[t] = slot_v3[t].node;
                    z_v4[t] = [0.0f32; 3];
                    if (i_e78[t] != 4294967295u32) {
                        let _e86 = <[f32; 4]>::load(m.image, 4 * (i_e78[t] as usize));
                        z_v4[t] = swizzle(_e86, [0, 1, 2]);
                    }
                    let mut local_v5: bool;
                    if (_e88 < _e91) {
                        let _e97 = m.params.levels;
                        local_v5 = (_e97 > 0u32);
                    } else {
                        local_v5 = false;
                    }
                    _e101[t] = local_v5;
                }
                if uniform(std::array::from_fn::<_, 256, _>(|t| _e101[t])) {
                    let _e104 = m.params.grouped;
                    for t in 0..256 {
                        is_grouped_e105[t] = (k_e60[t] < _e104);
                    }
                    for t in 0..256 {
                        let mut local_v6: bool;
                        if ((t_e2[t] % 64u32) < 8u32) {
                            local_v6 = is_grouped_e105[t];
                        } else {
                            local_v6 = false;
                        }
                        let _e113 = local_v6;
                        if _e113 {
                            find_motion(m, k_e60[t], q_e49[t], (t_e2[t] % 64u32));
                        }
                    }
                    for t in 0..256 {
                        if is_grouped_e105[t] {
                            let _e118 = slot_v3[t].arm[0];
                            let _e121 = slot_v3[t].arm[1];
                            let _e124 = slot_v3[t].arm[2];
                            let arm_e125 = [_e118, _e121, _e124];
                            let _e126 = z_v4[t];
                            let _e131 = m.shifts[(t_e2[t] / 8u32) as usize];
                            let _e136 = m.spins[(t_e2[t] / 8u32) as usize];
                            z_v4[t] = zip(_e126, zip(_e131, cross(_e136, arm_e125), |x, y| (x + y)), |x, y| (x + y));
                        }
                    }
                }
                for t in 0..256 {
                    if (i_e78[t] != 4294967295u32) {
                        let _e144 = m.params.start;
                        if (_e144 == 0u32) {
                            let _e147 = z_v4[t];
                            let _e148 = ratio_v0[t];
                            let _e151 = <[f32; 4]>::load(m.direction, 4 * (i_e78[t] as usize));
                            z_v4[t] = zip(_e147, swizzle(_e151, [0, 1, 2]).map(|x| (_e148 * x)), |x, y| (x + y));
                        }
                        let _e157 = z_v4[t];
                        Stored::store([(_e157)[0], (_e157)[1], (_e157)[2], 0.0f32], m.direction, 4 * (i_e78[t] as usize));
                    }
                }
            }
        }
        let _e160 = first_v2;
        let _e164 = m.params.workgroups;
        first_v2 = _e160.wrapping_add(4u32.wrapping_mul(_e164));
    }
}

pub fn run(bound: Bound<'_>) {
    let slots = bound.read(0);
    let links = bound.read(1);
    let group_motions = bound.read(2);
    let image = bound.read(3);
    let mut direction = bound.write(4);
    let sums = bound.read(5);
    let mut progress = bound.write(6);
    let mut m = Memory {
        params: bound.params(),
        slots: &slots,
        links: &links,
        group_motions: &group_motions,
        image: &image,
        direction: &mut direction,
        sums: &sums,
        progress: &mut progress,
        shared_sums: [0.0f32; 256],
        shared_pairs: [[0.0f32; 2]; 256],
        is_moving: 0u32,
        shifts: [[0.0f32; 3]; 32],
        spins: [[0.0f32; 3]; 32],
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        m.shared_pairs = [[0.0f32; 2]; 256];
        m.is_moving = 0u32;
        m.shifts = [[0.0f32; 3]; 32];
        m.spins = [[0.0f32; 3]; 32];
        main(&mut m, group as u32);
    }
}
}
