// Written from `shader/linear/matrix_product.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "matrix_product",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/sum.wgsl"),
        include_str!("../../shader/linear/matrix_product.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Read, Read, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const THREADS: u32 = 256u32;
pub const SLICE: u32 = 32u32;
pub const BLOCK_WORDS: u32 = 10u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub springs: u32,
    pub workgroups: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::matrix_product::*;
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

struct Memory<'a> {
    params: Params,
    slices: &'a [u32],
    words: &'a [u32],
    spring_words: &'a [u32],
    springs: &'a [u32],
    direction: &'a [u32],
    image: &'a mut [u32],
    sums: &'a mut [u32],
    progress: &'a mut [u32],
    shared_sums: [f32; 256],
    is_moving: u32,
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

pub fn number(m: &mut Memory<'_>, at_a0: u32) -> f32 {
    let _e3 = <u32>::load(m.words, 1 * (at_a0 as usize));
    return f32::from_bits(_e3 as u32);
}

pub fn column_of_block(m: &mut Memory<'_>, at_a0: u32) -> [f32; 3] {
    let _e1 = number(m, at_a0);
    let _e4 = number(m, at_a0.wrapping_add(32u32));
    let _e7 = number(m, at_a0.wrapping_add(64u32));
    return [_e1, _e4, _e7];
}

pub fn reaction(m: &mut Memory<'_>, spring_a0: Spring) -> [f32; 3] {
    let mut sum_v0: [f32; 3] = [0.0f32; 3];
    let mut k_v1: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e6 = k_v1;
            if (_e6 < 4u32) {
            } else {
                break 'l0;
            }
            {
                let _e9 = sum_v0;
                let _e11 = k_v1;
                let _e15 = k_v1;
                let _e18 = <[f32; 4]>::load(m.direction, 4 * (((spring_a0).nodes)[_e15 as usize] as usize));
                sum_v0 = zip(_e9, swizzle(_e18, [0, 1, 2]).map(|x| (((spring_a0).weights)[_e11 as usize] * x)), |x, y| (x + y));
            }
        }
        let _e22 = k_v1;
        k_v1 = _e22.wrapping_add(1u32);
    }
    let _e29 = sum_v0[0];
    let _e35 = sum_v0[1];
    let _e42 = sum_v0[2];
    return zip(zip(swizzle(((spring_a0).hessian)[0], [0, 1, 2]).map(|x| (x * _e29)), swizzle(((spring_a0).hessian)[1], [0, 1, 2]).map(|x| (x * _e35)), |x, y| (x + y)), swizzle(((spring_a0).hessian)[2], [0, 1, 2]).map(|x| (x * _e42)), |x, y| (x + y));
}

pub fn row(m: &mut Memory<'_>, i_a0: u32) -> [f32; 3] {
    let mut sum_v0: [f32; 3] = [0.0f32; 3];
    let mut k_v3: u32 = 0u32;
    let mut k_v5: u32 = 0u32;
    let slice_e5 = <[u32; 4]>::load(m.slices, 4 * ((i_a0 / 32u32) as usize));
    let _e8 = <[f32; 4]>::load(m.direction, 4 * (i_a0 as usize));
    let own_e9 = swizzle(_e8, [0, 1, 2]);
    let mut at_v1: u32;
    at_v1 = (slice_e5)[0].wrapping_add((i_a0 % 32u32));
    let mut blocks_v2: u32;
    blocks_v2 = (slice_e5)[1];
    if (((slice_e5)[3].wrapping_shr((i_a0 % 32u32)) & 1u32) == 1u32) {
        let _e30 = <[f32; 4]>::load(m.image, 4 * (i_a0 as usize));
        sum_v0 = swizzle(_e30, [0, 1, 2]);
        blocks_v2 = 1u32;
    }
    'l0: loop {
        'c0: {
            let _e35 = k_v3;
            let _e36 = blocks_v2;
            if (_e35 < _e36) {
            } else {
                break 'l0;
            }
            {
                let mut x_v4: [f32; 3];
                x_v4 = own_e9;
                let _e39 = k_v3;
                if (_e39 > 0u32) {
                    let _e44 = at_v1;
                    let _e46 = <u32>::load(m.words, 1 * (_e44 as usize));
                    let _e48 = <[f32; 4]>::load(m.direction, 4 * (_e46 as usize));
                    x_v4 = zip(swizzle(_e48, [0, 1, 2]), own_e9, |x, y| (x - y));
                }
                let _e51 = sum_v0;
                let _e52 = at_v1;
                let _e55 = column_of_block(m, _e52.wrapping_add(32u32));
                let _e57 = x_v4[0];
                sum_v0 = zip(_e51, _e55.map(|x| (x * _e57)), |x, y| (x + y));
                let _e60 = sum_v0;
                let _e61 = at_v1;
                let _e64 = column_of_block(m, _e61.wrapping_add(128u32));
                let _e66 = x_v4[1];
                sum_v0 = zip(_e60, _e64.map(|x| (x * _e66)), |x, y| (x + y));
                let _e69 = sum_v0;
                let _e70 = at_v1;
                let _e73 = column_of_block(m, _e70.wrapping_add(224u32));
                let _e75 = x_v4[2];
                sum_v0 = zip(_e69, _e73.map(|x| (x * _e75)), |x, y| (x + y));
                let _e78 = at_v1;
                at_v1 = _e78.wrapping_add(320u32);
            }
        }
        let _e81 = k_v3;
        k_v3 = _e81.wrapping_add(1u32);
    }
    at_v1 = (slice_e5)[0].wrapping_add((i_a0 % 32u32)).wrapping_add(320u32.wrapping_mul((slice_e5)[1]));
    'l1: loop {
        'c1: {
            let _e94 = k_v5;
            if (_e94 < (slice_e5)[2]) {
            } else {
                break 'l1;
            }
            {
                let _e97 = sum_v0;
                let _e98 = at_v1;
                let _e101 = number(m, _e98.wrapping_add(32u32));
                let _e104 = at_v1;
                let _e106 = <u32>::load(m.words, 1 * (_e104 as usize));
                let _e108 = <[f32; 4]>::load(m.direction, 4 * (_e106 as usize));
                sum_v0 = zip(_e97, zip(swizzle(_e108, [0, 1, 2]), own_e9, |x, y| (x - y)).map(|x| (_e101 * x)), |x, y| (x + y));
                let _e113 = at_v1;
                at_v1 = _e113.wrapping_add(64u32);
            }
        }
        let _e116 = k_v5;
        k_v5 = _e116.wrapping_add(1u32);
    }
    let _e121 = m.params.springs;
    if (_e121 > 0u32) {
        let end_e128 = <u32>::load(m.spring_words, 1 * (i_a0.wrapping_add(1u32) as usize));
        let _e131 = <u32>::load(m.spring_words, 1 * (i_a0 as usize));
        let mut e_v6: u32;
        e_v6 = _e131;
        'l2: loop {
            'c2: {
                let _e133 = e_v6;
                if (_e133 < end_e128) {
                } else {
                    break 'l2;
                }
                {
                    let _e135 = sum_v0;
                    let _e137 = e_v6;
                    let _e141 = <u32>::load(m.spring_words, 1 * (_e137.wrapping_add(1u32) as usize));
                    let _e145 = e_v6;
                    let _e147 = <u32>::load(m.spring_words, 1 * (_e145 as usize));
                    let _e149 = <Spring>::load(m.springs, 20 * (_e147 as usize));
                    let _e150 = reaction(m, _e149);
                    sum_v0 = zip(_e135, _e150.map(|x| (f32::from_bits(_e141 as u32) * x)), |x, y| (x + y));
                }
            }
            let _e153 = e_v6;
            e_v6 = _e153.wrapping_add(2u32);
        }
    }
    let _e156 = sum_v0;
    return _e156;
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut curvature_v0: [f32; 256] = [0.0f32; 256];
    let mut _e49: [f32; 256] = [0.0f32; 256];
    let mut sum_e50: [f32; 256] = [0.0f32; 256];
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e8 = <u32>::load(m.progress, 0);
            m.is_moving = _e8;
        }
    }
    let _e10 = { let t = 0; m.is_moving };
    if (_e10 == 0u32) {
        return;
    }
    for t in 0..256 {
        let mut i_v1: u32;
        i_v1 = 256u32.wrapping_mul(([group, 0, 0])[0]).wrapping_add(([t as u32, 0, 0])[0]);
        'l0: loop {
            'c0: {
                let _e21 = i_v1;
                let _e24 = m.params.nodes;
                if (_e21 < _e24) {
                } else {
                    break 'l0;
                }
                {
                    let _e26 = i_v1;
                    let product_e27 = row(m, _e26);
                    let _e29 = i_v1;
                    Stored::store([(product_e27)[0], (product_e27)[1], (product_e27)[2], 0.0f32], m.image, 4 * (_e29 as usize));
                    let _e33 = curvature_v0[t];
                    let _e35 = i_v1;
                    let _e37 = <[f32; 4]>::load(m.direction, 4 * (_e35 as usize));
                    curvature_v0[t] = (_e33 + dot(swizzle(_e37, [0, 1, 2]), product_e27));
                }
            }
            let _e41 = i_v1;
            let _e45 = m.params.workgroups;
            i_v1 = _e41.wrapping_add(256u32.wrapping_mul(_e45));
        }
        _e49[t] = curvature_v0[t];
    }
    sum_e50 = sum_of_threads(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e49[t]));
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            Stored::store(sum_e50[t], m.sums, 1 * (([group, 0, 0])[0] as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let slices = bound.read(0);
    let words = bound.read(1);
    let spring_words = bound.read(2);
    let springs = bound.read(3);
    let direction = bound.read(4);
    let mut image = bound.write(5);
    let mut sums = bound.write(6);
    let mut progress = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        slices: &slices,
        words: &words,
        spring_words: &spring_words,
        springs: &springs,
        direction: &direction,
        image: &mut image,
        sums: &mut sums,
        progress: &mut progress,
        shared_sums: [0.0f32; 256],
        is_moving: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.shared_sums = [0.0f32; 256];
        m.is_moving = 0u32;
        main(&mut m, group as u32);
    }
}
}
