// Written from `shader/preconditioner/coarsen_blocks.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "coarsen_blocks",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/groups.wgsl"),
        include_str!("../../shader/preconditioner/coarsen_blocks.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const BATCH: u32 = 64u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub pairs: u32,
    pub first: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::coarsen_blocks::*;
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

#[derive(Clone, Copy)]
pub struct Part {
    pub block: u32,
    pub a: u32,
    pub b: u32,
    pub both: u32,
}

impl Part {
    const ZERO: Self = Self {
        block: 0u32,
        a: 0u32,
        b: 0u32,
        both: 0u32,
    };
}

impl Stored for Part {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            block: <u32>::load(words, at + 0),
            a: <u32>::load(words, at + 1),
            b: <u32>::load(words, at + 2),
            both: <u32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.block.store(words, at + 0);
        self.a.store(words, at + 1);
        self.b.store(words, at + 2);
        self.both.store(words, at + 3);
    }
}

struct Memory<'a> {
    params: Params,
    sums: &'a [u32],
    parts: &'a [u32],
    frames: &'a [u32],
    couplings: &'a mut [u32],
    blocks: [[u32; 2]; 64],
    own_links: [[f32; 4]; 64],
    other_links: [[f32; 4]; 64],
}

pub fn between(a_a0: [i32; 3], b_a1: [i32; 3], quantum_a2: f32) -> [f32; 3] {
    return zip(b_a1, a_a0, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * quantum_a2));
}

pub fn link(m: &mut Memory<'_>, group_a0: u32, part_a1: u32) -> [f32; 4] {
    let parent_e4 = <Frame>::load(m.frames, 16 * (group_a0 as usize));
    let child_e7 = <Frame>::load(m.frames, 16 * (part_a1 as usize));
    let _e12 = m.params.quantum;
    let _e13 = between((parent_e4).center, (child_e7).center, _e12);
    let _e14 = (child_e7).size;
    return zip([(_e13)[0], (_e13)[1], (_e13)[2], _e14], [(parent_e4).size; 4], |x, y| (x / y));
}

pub fn image(m: &mut Memory<'_>, at_a0: u32, other_a1: [f32; 4], r_a2: u32, k_a3: u32) -> f32 {
    let row_e6 = at_a0.wrapping_add(6u32.wrapping_mul(r_a2));
    if (k_a3 < 3u32) {
        let _e12 = <f32>::load(m.couplings, 1 * (row_e6.wrapping_add(k_a3) as usize));
        return _e12;
    }
    let _e16 = <f32>::load(m.couplings, 1 * (row_e6 as usize));
    let _e21 = <f32>::load(m.couplings, 1 * (row_e6.wrapping_add(1u32) as usize));
    let _e26 = <f32>::load(m.couplings, 1 * (row_e6.wrapping_add(2u32) as usize));
    let moment_e28 = cross(swizzle(other_a1, [0, 1, 2]), [_e16, _e21, _e26]);
    let _e36 = <f32>::load(m.couplings, 1 * (row_e6.wrapping_add(k_a3) as usize));
    return ((moment_e28)[k_a3.wrapping_sub(3u32) as usize] + ((other_a1)[3] * _e36));
}

pub fn product(m: &mut Memory<'_>, part_a0: u32, r_a1: u32, k_a2: u32) -> f32 {
    let at_e6 = m.blocks[part_a0 as usize][0];
    let other_e9 = m.other_links[part_a0 as usize];
    if (r_a1 < 3u32) {
        let _e12 = image(m, at_e6, other_e9, r_a1, k_a2);
        return _e12;
    }
    let _e14 = image(m, at_e6, other_e9, 0u32, k_a2);
    let _e16 = image(m, at_e6, other_e9, 1u32, k_a2);
    let _e18 = image(m, at_e6, other_e9, 2u32, k_a2);
    let force_e19 = [_e14, _e16, _e18];
    let own_e22 = m.own_links[part_a0 as usize];
    let _e29 = image(m, at_e6, other_e9, r_a1, k_a2);
    return ((cross(swizzle(own_e22, [0, 1, 2]), force_e19))[r_a1.wrapping_sub(3u32) as usize] + ((own_e22)[3] * _e29));
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut pair_v0: u32 = 0u32;
    let mut total_v1: [f32; 64] = [0.0f32; 64];
    let mut begin_v2: u32 = 0u32;
    let mut t_e2: [u32; 64] = [0u32; 64];
    let mut r_e4: [u32; 64] = [0u32; 64];
    let mut k_e6: [u32; 64] = [0u32; 64];
    let mut sum_e21: [[u32; 4]; 64] = [[0u32; 4]; 64];
    let mut count_e33: [u32; 64] = [0u32; 64];
    for t in 0..64 {
        t_e2[t] = ([t as u32, 0, 0])[0];
        r_e4[t] = (t_e2[t] / 6u32);
        k_e6[t] = (t_e2[t] % 6u32);
    }
    pair_v0 = ([group, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e9 = pair_v0;
            let _e12 = m.params.pairs;
            if (_e9 < _e12) {
            } else {
                break 'l0;
            }
            {
                let _e17 = m.params.first;
                let _e18 = pair_v0;
                for t in 0..64 {
                    sum_e21[t] = <[u32; 4]>::load(m.sums, 4 * (_e17.wrapping_add(_e18) as usize));
                    total_v1[t] = 0.0f32;
                }
                begin_v2 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e26 = begin_v2;
                        if uniform(std::array::from_fn::<_, 64, _>(|t| (_e26 < (sum_e21[t])[1]))) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e31 = begin_v2;
                            for t in 0..64 {
                                count_e33[t] = 64u32.min((sum_e21[t])[1].wrapping_sub(_e31));
                            }
                            for t in 0..64 {
                                if (t_e2[t] < count_e33[t]) {
                                    let _e37 = begin_v2;
                                    let part_e41 = <Part>::load(m.parts, 4 * ((sum_e21[t])[0].wrapping_add(_e37).wrapping_add(t_e2[t]) as usize));
                                    let _e46 = 36u32.wrapping_mul((part_e41).block);
                                    let _e47 = (part_e41).both;
                                    m.blocks[t_e2[t] as usize] = [_e46, _e47];
                                    let _e53 = link(m, (sum_e21[t])[2], (part_e41).a);
                                    m.own_links[t_e2[t] as usize] = _e53;
                                    let _e58 = link(m, (sum_e21[t])[3], (part_e41).b);
                                    m.other_links[t_e2[t] as usize] = _e58;
                                }
                            }
                            for t in 0..64 {
                                let mut part_v3: u32;
                                part_v3 = 0u32;
                                'l2: loop {
                                    'c2: {
                                        let _e61 = part_v3;
                                        let mut local_v4: bool;
                                        if (_e61 < count_e33[t]) {
                                            local_v4 = (t_e2[t] < 36u32);
                                        } else {
                                            local_v4 = false;
                                        }
                                        let _e68 = local_v4;
                                        if _e68 {
                                        } else {
                                            break 'l2;
                                        }
                                        {
                                            let _e70 = part_v3;
                                            let _e73 = m.blocks[_e70 as usize][1];
                                            if (_e73 == 0u32) {
                                                let _e76 = total_v1[t];
                                                let _e77 = part_v3;
                                                let _e78 = product(m, _e77, r_e4[t], k_e6[t]);
                                                total_v1[t] = (_e76 + _e78);
                                            } else {
                                                let _e80 = total_v1[t];
                                                let _e81 = part_v3;
                                                let _e84 = product(m, _e81, r_e4[t].max(k_e6[t]), r_e4[t].min(k_e6[t]));
                                                total_v1[t] = (_e80 + _e84);
                                                let _e86 = total_v1[t];
                                                let _e87 = part_v3;
                                                let _e90 = product(m, _e87, r_e4[t].min(k_e6[t]), r_e4[t].max(k_e6[t]));
                                                total_v1[t] = (_e86 + _e90);
                                            }
                                        }
                                    }
                                    let _e92 = part_v3;
                                    part_v3 = _e92.wrapping_add(1u32);
                                }
                            }
                        }
                    }
                    let _e95 = begin_v2;
                    begin_v2 = _e95.wrapping_add(64u32);
                }
                for t in 0..64 {
                    if (t_e2[t] < 36u32) {
                        let _e104 = m.params.first;
                        let _e105 = pair_v0;
                        let _e110 = total_v1[t];
                        Stored::store(_e110, m.couplings, 1 * (36u32.wrapping_mul(_e104.wrapping_add(_e105)).wrapping_add(t_e2[t]) as usize));
                    }
                }
            }
        }
        let _e111 = pair_v0;
        pair_v0 = _e111.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let sums = bound.read(0);
    let parts = bound.read(1);
    let frames = bound.read(2);
    let mut couplings = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        sums: &sums,
        parts: &parts,
        frames: &frames,
        couplings: &mut couplings,
        blocks: [[0u32; 2]; 64],
        own_links: [[0.0f32; 4]; 64],
        other_links: [[0.0f32; 4]; 64],
    };
    for group in 0..bound.workgroups() {
        m.blocks = [[0u32; 2]; 64];
        m.own_links = [[0.0f32; 4]; 64];
        m.other_links = [[0.0f32; 4]; 64];
        main(&mut m, group as u32);
    }
}
}
