// Written from `shader/preconditioner/galerkin_blocks.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "galerkin_blocks",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/groups.wgsl"),
        include_str!("../../shader/preconditioner/galerkin_blocks.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const SLICE: u32 = 32u32;
pub const BLOCK_WORDS: u32 = 10u32;
pub const SHARE: u32 = 37u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub pairs: u32,
    pub first: u32,
    pub width: u32,
    pub first_frame: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::galerkin_blocks::*;
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
pub struct Row {
    pub shift: [[f32; 3]; 3],
    pub spin: [[f32; 3]; 3],
}

impl Row {
    const ZERO: Self = Self {
        shift: [[0.0f32; 3]; 3],
        spin: [[0.0f32; 3]; 3],
    };
}

impl Stored for Row {
    const WORDS: usize = 24;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            shift: std::array::from_fn(|k| Stored::load(words, at + 0 + 4 * k)),
            spin: std::array::from_fn(|k| Stored::load(words, at + 12 + 4 * k)),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.shift.store(words, at + 0);
        self.spin.store(words, at + 12);
    }
}

struct Memory<'a> {
    params: Params,
    pairs: &'a [u32],
    slices: &'a [u32],
    words: &'a [u32],
    slots: &'a [u32],
    places: &'a [u32],
    positions: &'a [u32],
    frames: &'a [u32],
    couplings: &'a mut [u32],
    shares: [f32; 2368],
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

pub fn number(m: &mut Memory<'_>, at_a0: u32) -> f32 {
    let _e3 = <u32>::load(m.words, 1 * (at_a0 as usize));
    return f32::from_bits(_e3 as u32);
}

pub fn arm_of(m: &mut Memory<'_>, node_a0: u32, frame_a1: Frame) -> [f32; 3] {
    let _e5 = <[i32; 4]>::load(m.positions, 4 * (node_a0 as usize));
    let _e9 = m.params.quantum;
    let _e10 = between((frame_a1).center, swizzle(_e5, [0, 1, 2]), _e9);
    return zip(_e10, [(frame_a1).size; 3], |x, y| (x / y));
}

pub fn add(m: &mut Memory<'_>, row_a0: Row, pair_a1: [u32; 2], j_a2: u32, h_a3: [[f32; 3]; 3], arm_a4: [f32; 3], frame_a5: Frame) -> Row {
    let mut sum_v0: Row;
    sum_v0 = row_a0;
    let place_e9 = <u32>::load(m.places, 1 * (j_a2 as usize));
    let mut local_v1: bool;
    if (place_e9 != 4294967295u32) {
        let _e16 = m.params.width;
        local_v1 = ((place_e9 / _e16) == (pair_a1)[1]);
    } else {
        local_v1 = false;
    }
    let is_in_b_e21 = local_v1;
    if ((pair_a1)[0] != (pair_a1)[1]) {
        if is_in_b_e21 {
            let _e26 = sum_v0.shift;
            sum_v0.shift = zip(_e26, h_a3, |a, b| zip(a, b, |x, y| (x + y)));
            let _e29 = sum_v0.spin;
            let _e30 = arm_of(m, j_a2, frame_a5);
            let _e31 = times_spin(h_a3, _e30);
            sum_v0.spin = zip(_e29, _e31, |a, b| zip(a, b, |x, y| (x + y)));
        }
    } else {
        if is_in_b_e21 {
            let _e34 = sum_v0.spin;
            let _e35 = arm_of(m, j_a2, frame_a5);
            let _e37 = times_spin(h_a3, zip(_e35, arm_a4, |x, y| (x - y)));
            sum_v0.spin = zip(_e34, _e37, |a, b| zip(a, b, |x, y| (x + y)));
        } else {
            let _e40 = sum_v0.shift;
            sum_v0.shift = zip(_e40, h_a3, |a, b| zip(a, b, |x, y| (x - y)));
            let _e43 = sum_v0.spin;
            let _e44 = times_spin(h_a3, arm_a4);
            sum_v0.spin = zip(_e43, _e44, |a, b| zip(a, b, |x, y| (x - y)));
        }
    }
    let _e46 = sum_v0;
    return _e46;
}

pub fn row_of(m: &mut Memory<'_>, i_a0: u32, pair_a1: [u32; 2], arm_a2: [f32; 3], frame_a3: Frame) -> Row {
    let mut row_v1: Row = Row::ZERO;
    let mut k_v2: u32 = 0u32;
    let mut k_v3: u32 = 0u32;
    let slice_e8 = <[u32; 4]>::load(m.slices, 4 * ((i_a0 / 32u32) as usize));
    let mut at_v0: u32;
    at_v0 = (slice_e8)[0].wrapping_add((i_a0 % 32u32));
    'l0: loop {
        'c0: {
            let _e17 = k_v2;
            if (_e17 < (slice_e8)[1]) {
            } else {
                break 'l0;
            }
            {
                let _e20 = at_v0;
                let _e23 = number(m, _e20.wrapping_add(32u32));
                let _e24 = at_v0;
                let _e27 = number(m, _e24.wrapping_add(64u32));
                let _e28 = at_v0;
                let _e31 = number(m, _e28.wrapping_add(96u32));
                let _e32 = [_e23, _e27, _e31];
                let _e33 = at_v0;
                let _e36 = number(m, _e33.wrapping_add(128u32));
                let _e37 = at_v0;
                let _e40 = number(m, _e37.wrapping_add(160u32));
                let _e41 = at_v0;
                let _e44 = number(m, _e41.wrapping_add(192u32));
                let _e45 = [_e36, _e40, _e44];
                let _e46 = at_v0;
                let _e49 = number(m, _e46.wrapping_add(224u32));
                let _e50 = at_v0;
                let _e53 = number(m, _e50.wrapping_add(256u32));
                let _e54 = at_v0;
                let _e57 = number(m, _e54.wrapping_add(288u32));
                let _e58 = [_e49, _e53, _e57];
                let h_e59 = [_e32, _e45, _e58];
                let _e60 = k_v2;
                if (_e60 > 0u32) {
                    let _e63 = row_v1;
                    let _e65 = at_v0;
                    let _e67 = <u32>::load(m.words, 1 * (_e65 as usize));
                    let _e68 = add(m, _e63, pair_a1, _e67, h_e59, arm_a2, frame_a3);
                    row_v1 = _e68;
                } else {
                    if ((pair_a1)[0] == (pair_a1)[1]) {
                        row_v1.shift = h_e59;
                        let _e74 = times_spin(h_e59, arm_a2);
                        row_v1.spin = _e74;
                    }
                }
                let _e75 = at_v0;
                at_v0 = _e75.wrapping_add(320u32);
            }
        }
        let _e78 = k_v2;
        k_v2 = _e78.wrapping_add(1u32);
    }
    'l1: loop {
        'c1: {
            let _e83 = k_v3;
            if (_e83 < (slice_e8)[2]) {
            } else {
                break 'l1;
            }
            {
                let _e86 = at_v0;
                let q_e89 = number(m, _e86.wrapping_add(32u32));
                let _e92 = [q_e89, 0.0f32, 0.0f32];
                let _e95 = [0.0f32, q_e89, 0.0f32];
                let _e98 = [0.0f32, 0.0f32, q_e89];
                let h_e99 = [_e92, _e95, _e98];
                let _e100 = row_v1;
                let _e102 = at_v0;
                let _e104 = <u32>::load(m.words, 1 * (_e102 as usize));
                let _e105 = add(m, _e100, pair_a1, _e104, h_e99, arm_a2, frame_a3);
                row_v1 = _e105;
                let _e106 = at_v0;
                at_v0 = _e106.wrapping_add(64u32);
            }
        }
        let _e109 = k_v3;
        k_v3 = _e109.wrapping_add(1u32);
    }
    let _e112 = row_v1;
    return _e112;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut begin_v0: u32 = 0u32;
    let mut t_e2: [u32; 64] = [0u32; 64];
    let _e6 = m.params.width;
    let beside_e7 = (64u32 / _e6);
    for t in 0..64 {
        t_e2[t] = ([t as u32, 0, 0])[0];
    }
    begin_v0 = beside_e7.wrapping_mul(([group, 0, 0])[0]);
    'l0: loop {
        'c0: {
            let _e11 = begin_v0;
            let _e14 = m.params.pairs;
            if (_e11 < _e14) {
            } else {
                break 'l0;
            }
            {
                let _e16 = begin_v0;
                let _e19 = m.params.width;
                let _e30 = m.params.pairs;
                for t in 0..64 {
                    let p_e21 = _e16.wrapping_add((t_e2[t] / _e19));
                    let mut shift_v1: [[f32; 3]; 3];
                    shift_v1 = [[0.0f32; 3]; 3];
                    let mut spin_v2: [[f32; 3]; 3];
                    spin_v2 = [[0.0f32; 3]; 3];
                    let mut arm_v3: [f32; 3];
                    arm_v3 = [0.0f32; 3];
                    if (p_e21 < _e30) {
                        let _e35 = m.params.first;
                        let pair_e38 = <[u32; 2]>::load(m.pairs, 2 * (_e35.wrapping_add(p_e21) as usize));
                        let _e42 = m.params.width;
                        let _e47 = m.params.width;
                        let i_e52 = <u32>::load(m.slots, 12 * (_e42.wrapping_mul((pair_e38)[0]).wrapping_add((t_e2[t] % _e47)) as usize));
                        if (i_e52 != 4294967295u32) {
                            let _e58 = m.params.first_frame;
                            let _e62 = <Frame>::load(m.frames, 16 * (_e58.wrapping_add((pair_e38)[0]) as usize));
                            let _e63 = arm_of(m, i_e52, _e62);
                            arm_v3 = _e63;
                            let _e64 = arm_v3;
                            let _e68 = m.params.first_frame;
                            let _e72 = <Frame>::load(m.frames, 16 * (_e68.wrapping_add((pair_e38)[1]) as usize));
                            let row_e73 = row_of(m, i_e52, pair_e38, _e64, _e72);
                            shift_v1 = (row_e73).shift;
                            spin_v2 = (row_e73).spin;
                        }
                    }
                    let _e76 = arm_v3;
                    let _e77 = shift_v1;
                    let turned_shift_e78 = moments(_e76, _e77);
                    let _e79 = arm_v3;
                    let _e80 = spin_v2;
                    let turned_spin_e81 = moments(_e79, _e80);
                    let mut r_v4: u32;
                    r_v4 = 0u32;
                    'l1: loop {
                        'c1: {
                            let _e84 = r_v4;
                            if (_e84 < 3u32) {
                            } else {
                                break 'l1;
                            }
                            {
                                let mut k_v5: u32;
                                k_v5 = 0u32;
                                'l2: loop {
                                    'c2: {
                                        let _e89 = k_v5;
                                        if (_e89 < 3u32) {
                                        } else {
                                            break 'l2;
                                        }
                                        {
                                            let _e96 = r_v4;
                                            let _e99 = k_v5;
                                            let _e102 = k_v5;
                                            let _e104 = r_v4;
                                            let _e106 = shift_v1[_e102 as usize][_e104 as usize];
                                            m.shares[37u32.wrapping_mul(t_e2[t]).wrapping_add(6u32.wrapping_mul(_e96)).wrapping_add(_e99) as usize] = _e106;
                                            let _e111 = r_v4;
                                            let _e116 = k_v5;
                                            let _e119 = k_v5;
                                            let _e121 = r_v4;
                                            let _e123 = spin_v2[_e119 as usize][_e121 as usize];
                                            m.shares[37u32.wrapping_mul(t_e2[t]).wrapping_add(6u32.wrapping_mul(_e111)).wrapping_add(3u32).wrapping_add(_e116) as usize] = _e123;
                                            let _e128 = r_v4;
                                            let _e133 = k_v5;
                                            let _e136 = k_v5;
                                            let _e138 = r_v4;
                                            m.shares[37u32.wrapping_mul(t_e2[t]).wrapping_add(6u32.wrapping_mul(_e128.wrapping_add(3u32))).wrapping_add(_e133) as usize] = ((turned_shift_e78)[_e136 as usize])[_e138 as usize];
                                            let _e144 = r_v4;
                                            let _e151 = k_v5;
                                            let _e154 = k_v5;
                                            let _e156 = r_v4;
                                            m.shares[37u32.wrapping_mul(t_e2[t]).wrapping_add(6u32.wrapping_mul(_e144.wrapping_add(3u32))).wrapping_add(3u32).wrapping_add(_e151) as usize] = ((turned_spin_e81)[_e154 as usize])[_e156 as usize];
                                        }
                                    }
                                    let _e158 = k_v5;
                                    k_v5 = _e158.wrapping_add(1u32);
                                }
                            }
                        }
                        let _e161 = r_v4;
                        r_v4 = _e161.wrapping_add(1u32);
                    }
                }
                let _e167 = m.params.pairs;
                let _e168 = begin_v0;
                let end_e171 = 36u32.wrapping_mul(beside_e7.min(_e167.wrapping_sub(_e168)));
                for t in 0..64 {
                    let mut k_v6: u32;
                    k_v6 = t_e2[t];
                    'l3: loop {
                        'c3: {
                            let _e173 = k_v6;
                            if (_e173 < end_e171) {
                            } else {
                                break 'l3;
                            }
                            {
                                let mut sum_v7: f32;
                                sum_v7 = 0.0f32;
                                let _e180 = m.params.width;
                                let _e182 = k_v6;
                                let _e186 = k_v6;
                                let first_e189 = 37u32.wrapping_mul(_e180).wrapping_mul((_e182 / 36u32)).wrapping_add((_e186 % 36u32));
                                let mut m_v8: u32;
                                m_v8 = 0u32;
                                'l4: loop {
                                    'c4: {
                                        let _e192 = m_v8;
                                        let _e195 = m.params.width;
                                        if (_e192 < _e195) {
                                        } else {
                                            break 'l4;
                                        }
                                        {
                                            let _e197 = sum_v7;
                                            let _e200 = m_v8;
                                            let _e204 = m.shares[first_e189.wrapping_add(37u32.wrapping_mul(_e200)) as usize];
                                            sum_v7 = (_e197 + _e204);
                                        }
                                    }
                                    let _e206 = m_v8;
                                    m_v8 = _e206.wrapping_add(1u32);
                                }
                                let _e213 = m.params.first;
                                let _e214 = begin_v0;
                                let _e217 = k_v6;
                                let _e220 = sum_v7;
                                Stored::store(_e220, m.couplings, 1 * (36u32.wrapping_mul(_e213.wrapping_add(_e214)).wrapping_add(_e217) as usize));
                            }
                        }
                        let _e221 = k_v6;
                        k_v6 = _e221.wrapping_add(64u32);
                    }
                }
            }
        }
        let _e224 = begin_v0;
        begin_v0 = _e224.wrapping_add(beside_e7.wrapping_mul(65535u32));
    }
}

pub fn run(bound: Bound<'_>) {
    let pairs = bound.read(0);
    let slices = bound.read(1);
    let words = bound.read(2);
    let slots = bound.read(3);
    let places = bound.read(4);
    let positions = bound.read(5);
    let frames = bound.read(6);
    let mut couplings = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        pairs: &pairs,
        slices: &slices,
        words: &words,
        slots: &slots,
        places: &places,
        positions: &positions,
        frames: &frames,
        couplings: &mut couplings,
        shares: [0.0f32; 2368],
    };
    for group in 0..bound.workgroups() {
        m.shares = [0.0f32; 2368];
        main(&mut m, group as u32);
    }
}
}
