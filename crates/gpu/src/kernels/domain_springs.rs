// Written from `shader/preconditioner/domain_springs.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "domain_springs",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/groups.wgsl"),
        include_str!("../../shader/preconditioner/domain_springs.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const BATCH: u32 = 32u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub chunks: u32,
    pub first: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::domain_springs::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Spring {
    pub nodes: [u32; 4],
    pub weights: [f32; 4],
    pub hessian: [[f32; 4]; 3],
}

impl Spring {
    const ZERO: Self = Self {
        nodes: [0u32; 4],
        weights: [0.0f32; 4],
        hessian: [[0.0f32; 4]; 3],
    };
}

impl Stored for Spring {
    const WORDS: usize = 20;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            nodes: <[u32; 4]>::load(words, at + 0),
            weights: <[f32; 4]>::load(words, at + 4),
            hessian: <[[f32; 4]; 3]>::load(words, at + 8),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.nodes.store(words, at + 0);
        self.weights.store(words, at + 4);
        self.hessian.store(words, at + 8);
    }
}

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
pub struct Chunk {
    pub begin: u32,
    pub end: u32,
    pub width: u32,
    pub group: u32,
    pub frame: u32,
}

impl Chunk {
    const ZERO: Self = Self {
        begin: 0u32,
        end: 0u32,
        width: 0u32,
        group: 0u32,
        frame: 0u32,
    };
}

impl Stored for Chunk {
    const WORDS: usize = 5;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            begin: <u32>::load(words, at + 0),
            end: <u32>::load(words, at + 1),
            width: <u32>::load(words, at + 2),
            group: <u32>::load(words, at + 3),
            frame: <u32>::load(words, at + 4),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.begin.store(words, at + 0);
        self.end.store(words, at + 1);
        self.width.store(words, at + 2);
        self.group.store(words, at + 3);
        self.frame.store(words, at + 4);
    }
}

struct Memory<'a> {
    params: Params,
    springs: &'a [u32],
    touching: &'a [u32],
    places: &'a [u32],
    positions: &'a [u32],
    frames: &'a [u32],
    pressed: &'a mut [u32],
    hessians: [[[f32; 3]; 3]; 32],
    groups: [u32; 128],
    arms: [[f32; 4]; 128],
}

pub fn between(a_a0: [i32; 3], b_a1: [i32; 3], quantum_a2: f32) -> [f32; 3] {
    return zip(b_a1, a_a0, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * quantum_a2));
}

pub fn times_spin(h_a0: [[f32; 3]; 3], arm_a1: [f32; 3]) -> [[f32; 3]; 3] {
    let _e8 = zip((h_a0)[2].map(|x| (x * (arm_a1)[1])), (h_a0)[1].map(|x| (x * (arm_a1)[2])), |x, y| (x - y));
    let _e15 = zip((h_a0)[0].map(|x| (x * (arm_a1)[2])), (h_a0)[2].map(|x| (x * (arm_a1)[0])), |x, y| (x - y));
    let _e22 = zip((h_a0)[1].map(|x| (x * (arm_a1)[0])), (h_a0)[0].map(|x| (x * (arm_a1)[1])), |x, y| (x - y));
    return [_e8, _e15, _e22];
}

pub fn moments(arm_a0: [f32; 3], f_a1: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let _e3 = cross(arm_a0, (f_a1)[0]);
    let _e5 = cross(arm_a0, (f_a1)[1]);
    let _e7 = cross(arm_a0, (f_a1)[2]);
    return [_e3, _e5, _e7];
}

pub fn look_up(m: &mut Memory<'_>, chunk_a0: Chunk, spring_a1: Spring, k_a2: u32, at_a3: u32) {
    let mut group_v0: u32 = 8u32;
    let node_e5 = ((spring_a1).nodes)[k_a2 as usize];
    let mut local_v1: bool;
    if (((spring_a1).weights)[k_a2 as usize] != 0.0f32) {
        let _e16 = <u32>::load(m.places, 1 * (node_e5 as usize));
        local_v1 = (_e16 != 4294967295u32);
    } else {
        local_v1 = false;
    }
    let _e20 = local_v1;
    if _e20 {
        let _e23 = <u32>::load(m.places, 1 * (node_e5 as usize));
        group_v0 = (_e23 / (chunk_a0).width).wrapping_sub((chunk_a0).group).min(8u32);
    }
    let _e32 = group_v0;
    m.groups[at_a3 as usize] = _e32;
    let _e33 = group_v0;
    if (_e33 < 8u32) {
        let _e38 = group_v0;
        let frame_e41 = <Frame>::load(m.frames, 16 * ((chunk_a0).frame.wrapping_add(_e38) as usize));
        let _e45 = <[i32; 4]>::load(m.positions, 4 * (node_e5 as usize));
        let _e49 = m.params.quantum;
        let _e50 = between((frame_e41).center, swizzle(_e45, [0, 1, 2]), _e49);
        let arm_e53 = zip(_e50, [(frame_e41).size; 3], |x, y| (x / y));
        let _e57 = ((spring_a1).weights)[k_a2 as usize];
        m.arms[at_a3 as usize] = [(arm_e53)[0], (arm_e53)[1], (arm_e53)[2], _e57];
    }
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut c_v0: u32 = 0u32;
    let mut shifts_v1: [[[f32; 3]; 3]; 64] = [[[0.0f32; 3]; 3]; 64];
    let mut spins_v2: [[[f32; 3]; 3]; 64] = [[[0.0f32; 3]; 3]; 64];
    let mut turned_shifts_v3: [[[f32; 3]; 3]; 64] = [[[0.0f32; 3]; 3]; 64];
    let mut turned_spins_v4: [[[f32; 3]; 3]; 64] = [[[0.0f32; 3]; 3]; 64];
    let mut begin_v5: [u32; 64] = [0u32; 64];
    let mut t_e2: [u32; 64] = [0u32; 64];
    let mut a_e4: [u32; 64] = [0u32; 64];
    let mut b_e6: [u32; 64] = [0u32; 64];
    let mut chunk_e44: [Chunk; 64] = [Chunk::ZERO; 64];
    let mut _e55: [u32; 64] = [0u32; 64];
    let mut count_e62: [u32; 64] = [0u32; 64];
    for t in 0..64 {
        t_e2[t] = ([t as u32, 0, 0])[0];
        a_e4[t] = (t_e2[t] / 8u32);
        b_e6[t] = (t_e2[t] % 8u32);
    }
    c_v0 = ([group, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e9 = c_v0;
            let _e12 = m.params.chunks;
            if (_e9 < _e12) {
            } else {
                break 'l0;
            }
            {
                let _e16 = m.params.first;
                let _e18 = c_v0;
                let at_e20 = _e16.wrapping_add(5u32.wrapping_mul(_e18));
                for t in 0..64 {
                    let _e23 = <u32>::load(m.touching, 1 * (at_e20 as usize));
                    let _e28 = <u32>::load(m.touching, 1 * (at_e20.wrapping_add(1u32) as usize));
                    let _e33 = <u32>::load(m.touching, 1 * (at_e20.wrapping_add(2u32) as usize));
                    let _e38 = <u32>::load(m.touching, 1 * (at_e20.wrapping_add(3u32) as usize));
                    let _e43 = <u32>::load(m.touching, 1 * (at_e20.wrapping_add(4u32) as usize));
                    chunk_e44[t] = Chunk { begin: _e23, end: _e28, width: _e33, group: _e38, frame: _e43 };
                    shifts_v1[t] = [[0.0f32; 3]; 3];
                    spins_v2[t] = [[0.0f32; 3]; 3];
                    turned_shifts_v3[t] = [[0.0f32; 3]; 3];
                    turned_spins_v4[t] = [[0.0f32; 3]; 3];
                    begin_v5[t] = (chunk_e44[t]).begin;
                }
                'l1: loop {
                    'c1: {
                        for t in 0..64 {
                            _e55[t] = begin_v5[t];
                        }
                        if uniform(std::array::from_fn::<_, 64, _>(|t| (_e55[t] < (chunk_e44[t]).end))) {
                        } else {
                            break 'l1;
                        }
                        {
                            for t in 0..64 {
                                let _e60 = begin_v5[t];
                                count_e62[t] = 32u32.min((chunk_e44[t]).end.wrapping_sub(_e60));
                            }
                            for t in 0..64 {
                                let mut k_v6: u32;
                                k_v6 = t_e2[t];
                                'l2: loop {
                                    'c2: {
                                        let _e64 = k_v6;
                                        if (_e64 < 4u32.wrapping_mul(count_e62[t])) {
                                        } else {
                                            break 'l2;
                                        }
                                        {
                                            let _e70 = begin_v5[t];
                                            let _e71 = k_v6;
                                            let _e76 = <u32>::load(m.touching, 1 * (_e70.wrapping_add((_e71 / 4u32)) as usize));
                                            let spring_e78 = <Spring>::load(m.springs, 20 * (_e76 as usize));
                                            let _e79 = k_v6;
                                            let _e82 = k_v6;
                                            look_up(m, chunk_e44[t], spring_e78, (_e79 % 4u32), _e82);
                                            let _e83 = k_v6;
                                            if ((_e83 % 4u32) == 0u32) {
                                                let _e89 = k_v6;
                                                let _e95 = swizzle(((spring_e78).hessian)[0], [0, 1, 2]);
                                                let _e98 = swizzle(((spring_e78).hessian)[1], [0, 1, 2]);
                                                let _e101 = swizzle(((spring_e78).hessian)[2], [0, 1, 2]);
                                                m.hessians[(_e89 / 4u32) as usize] = [_e95, _e98, _e101];
                                            }
                                        }
                                    }
                                    let _e103 = k_v6;
                                    k_v6 = _e103.wrapping_add(64u32);
                                }
                            }
                            for t in 0..64 {
                                let mut s_v7: u32;
                                s_v7 = 0u32;
                                'l3: loop {
                                    'c3: {
                                        let _e108 = s_v7;
                                        let mut local_v8: bool;
                                        if (_e108 < count_e62[t]) {
                                            local_v8 = (a_e4[t] <= b_e6[t]);
                                        } else {
                                            local_v8 = false;
                                        }
                                        let _e114 = local_v8;
                                        if _e114 {
                                        } else {
                                            break 'l3;
                                        }
                                        {
                                            let _e116 = s_v7;
                                            let mut m_v9: u32;
                                            m_v9 = 4u32.wrapping_mul(_e116);
                                            'l4: loop {
                                                'c4: {
                                                    let _e119 = m_v9;
                                                    let _e121 = s_v7;
                                                    if (_e119 < 4u32.wrapping_mul(_e121).wrapping_add(4u32)) {
                                                    } else {
                                                        break 'l4;
                                                    }
                                                    {
                                                        let _e127 = m_v9;
                                                        let _e129 = m.groups[_e127 as usize];
                                                        if (_e129 != a_e4[t]) {
                                                            break 'c4;
                                                        }
                                                        let _e132 = s_v7;
                                                        let mut n_v10: u32;
                                                        n_v10 = 4u32.wrapping_mul(_e132);
                                                        'l5: loop {
                                                            'c5: {
                                                                let _e135 = n_v10;
                                                                let _e137 = s_v7;
                                                                if (_e135 < 4u32.wrapping_mul(_e137).wrapping_add(4u32)) {
                                                                } else {
                                                                    break 'l5;
                                                                }
                                                                {
                                                                    let _e143 = n_v10;
                                                                    let _e145 = m.groups[_e143 as usize];
                                                                    if (_e145 != b_e6[t]) {
                                                                        break 'c5;
                                                                    }
                                                                    let _e148 = s_v7;
                                                                    let _e150 = m.hessians[_e148 as usize];
                                                                    let _e152 = m_v9;
                                                                    let _e155 = m.arms[_e152 as usize][3];
                                                                    let _e157 = n_v10;
                                                                    let _e160 = m.arms[_e157 as usize][3];
                                                                    let shift_e162 = _e150.map(|column| column.map(|x| (x * (_e155 * _e160))));
                                                                    let _e164 = n_v10;
                                                                    let _e166 = m.arms[_e164 as usize];
                                                                    let spin_e168 = times_spin(shift_e162, swizzle(_e166, [0, 1, 2]));
                                                                    let _e169 = shifts_v1[t];
                                                                    shifts_v1[t] = zip(_e169, shift_e162, |a, b| zip(a, b, |x, y| (x + y)));
                                                                    let _e171 = spins_v2[t];
                                                                    spins_v2[t] = zip(_e171, spin_e168, |a, b| zip(a, b, |x, y| (x + y)));
                                                                    let _e173 = turned_shifts_v3[t];
                                                                    let _e175 = m_v9;
                                                                    let _e177 = m.arms[_e175 as usize];
                                                                    let _e179 = moments(swizzle(_e177, [0, 1, 2]), shift_e162);
                                                                    turned_shifts_v3[t] = zip(_e173, _e179, |a, b| zip(a, b, |x, y| (x + y)));
                                                                    let _e181 = turned_spins_v4[t];
                                                                    let _e183 = m_v9;
                                                                    let _e185 = m.arms[_e183 as usize];
                                                                    let _e187 = moments(swizzle(_e185, [0, 1, 2]), spin_e168);
                                                                    turned_spins_v4[t] = zip(_e181, _e187, |a, b| zip(a, b, |x, y| (x + y)));
                                                                }
                                                            }
                                                            let _e189 = n_v10;
                                                            n_v10 = _e189.wrapping_add(1u32);
                                                        }
                                                    }
                                                }
                                                let _e192 = m_v9;
                                                m_v9 = _e192.wrapping_add(1u32);
                                            }
                                        }
                                    }
                                    let _e195 = s_v7;
                                    s_v7 = _e195.wrapping_add(1u32);
                                }
                            }
                        }
                    }
                    for t in 0..64 {
                        let _e198 = begin_v5[t];
                        begin_v5[t] = _e198.wrapping_add(32u32);
                    }
                }
                for t in 0..64 {
                    if (a_e4[t] <= b_e6[t]) {
                        let mut r_v11: u32;
                        r_v11 = 0u32;
                        'l6: loop {
                            'c6: {
                                let _e204 = r_v11;
                                if (_e204 < 3u32) {
                                } else {
                                    break 'l6;
                                }
                                {
                                    let mut k_v12: u32;
                                    k_v12 = 0u32;
                                    'l7: loop {
                                        'c7: {
                                            let _e209 = k_v12;
                                            if (_e209 < 3u32) {
                                            } else {
                                                break 'l7;
                                            }
                                            {
                                                let _e213 = c_v0;
                                                let _e218 = r_v11;
                                                let _e225 = k_v12;
                                                let upper_e226 = 2304u32.wrapping_mul(_e213).wrapping_add(48u32.wrapping_mul(6u32.wrapping_mul(a_e4[t]).wrapping_add(_e218))).wrapping_add(6u32.wrapping_mul(b_e6[t])).wrapping_add(_e225);
                                                let _e229 = k_v12;
                                                let _e231 = r_v11;
                                                let _e233 = shifts_v1[t][_e229 as usize][_e231 as usize];
                                                Stored::store(_e233, m.pressed, 1 * (upper_e226 as usize));
                                                let _e238 = k_v12;
                                                let _e240 = r_v11;
                                                let _e242 = spins_v2[t][_e238 as usize][_e240 as usize];
                                                Stored::store(_e242, m.pressed, 1 * (upper_e226.wrapping_add(3u32) as usize));
                                                let _e247 = k_v12;
                                                let _e249 = r_v11;
                                                let _e251 = turned_shifts_v3[t][_e247 as usize][_e249 as usize];
                                                Stored::store(_e251, m.pressed, 1 * (upper_e226.wrapping_add(144u32) as usize));
                                                let _e256 = k_v12;
                                                let _e258 = r_v11;
                                                let _e260 = turned_spins_v4[t][_e256 as usize][_e258 as usize];
                                                Stored::store(_e260, m.pressed, 1 * (upper_e226.wrapping_add(147u32) as usize));
                                            }
                                        }
                                        let _e261 = k_v12;
                                        k_v12 = _e261.wrapping_add(1u32);
                                    }
                                }
                            }
                            let _e264 = r_v11;
                            r_v11 = _e264.wrapping_add(1u32);
                        }
                    }
                }
            }
        }
        let _e267 = c_v0;
        c_v0 = _e267.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let springs = bound.read(0);
    let touching = bound.read(1);
    let places = bound.read(2);
    let positions = bound.read(3);
    let frames = bound.read(4);
    let mut pressed = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        springs: &springs,
        touching: &touching,
        places: &places,
        positions: &positions,
        frames: &frames,
        pressed: &mut pressed,
        hessians: [[[0.0f32; 3]; 3]; 32],
        groups: [0u32; 128],
        arms: [[0.0f32; 4]; 128],
    };
    for group in 0..bound.workgroups() {
        m.hessians = [[[0.0f32; 3]; 3]; 32];
        m.groups = [0u32; 128];
        m.arms = [[0.0f32; 4]; 128];
        main(&mut m, group as u32);
    }
}
}
