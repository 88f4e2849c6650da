// Written from `shader/backward/scan_buckets.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "scan_buckets",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/scan.wgsl"),
        include_str!("../../shader/backward/scan_buckets.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const OBSTACLE: u32 = 1u32;
pub const PRESCRIBED: u32 = 2u32;
pub const SELF_COLLIDES: u32 = 4u32;
pub const KNOWN: u32 = 8u32;
pub const ELEMENT_BITS: u32 = 29u32;
pub const ELEMENT_MASK: u32 = 536870911u32;
pub const VERTEX_VERTEX: u32 = 0u32;
pub const VERTEX_EDGE: u32 = 1u32;
pub const VERTEX_TRIANGLE: u32 = 2u32;
pub const EDGE_EDGE: u32 = 3u32;
pub const VERTEX_HALF_SPACE: u32 = 4u32;
pub const COLORS: u32 = 128u32;
pub const FIXED: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub buckets: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::scan_buckets::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Bucket {
    pub first: u32,
    pub end: u32,
    pub colors: u32,
    pub most: u32,
}

impl Bucket {
    const ZERO: Self = Self {
        first: 0u32,
        end: 0u32,
        colors: 0u32,
        most: 0u32,
    };
}

impl Stored for Bucket {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            first: <u32>::load(words, at + 0),
            end: <u32>::load(words, at + 1),
            colors: <u32>::load(words, at + 2),
            most: <u32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.first.store(words, at + 0);
        self.end.store(words, at + 1);
        self.colors.store(words, at + 2);
        self.most.store(words, at + 3);
    }
}

struct Memory<'a> {
    params: Params,
    tally: &'a [u32],
    buckets: &'a mut [u32],
    sums: [u32; 256],
}

pub fn saturating_sum(a_a0: u32, b_a1: u32) -> u32 {
    return a_a0.wrapping_add(b_a1.min(4294967295u32.wrapping_sub(a_a0)));
}

pub fn sum_before(m: &mut Memory<'_>, thread_a0: [u32; 256], count_a1: [u32; 256]) -> [u32; 256] {
    let mut reach_v0: u32 = 1u32;
    let mut before_v1: [u32; 256] = [0u32; 256];
    let mut _e35: [u32; 256] = [0u32; 256];
    for t in 0..256 {
        m.sums[thread_a0[t] as usize] = count_a1[t];
    }
    'l0: loop {
        'c0: {
            let _e6 = reach_v0;
            if (_e6 < 256u32) {
            } else {
                break 'l0;
            }
            {
                let _e11 = reach_v0;
                for t in 0..256 {
                    before_v1[t] = 0u32;
                    if (thread_a0[t] >= _e11) {
                        let _e14 = reach_v0;
                        let _e17 = m.sums[thread_a0[t].wrapping_sub(_e14) as usize];
                        before_v1[t] = _e17;
                    }
                }
                for t in 0..256 {
                    let _e20 = before_v1[t];
                    let _e23 = m.sums[thread_a0[t] as usize];
                    let _e24 = saturating_sum(_e20, _e23);
                    m.sums[thread_a0[t] as usize] = _e24;
                }
            }
        }
        let _e25 = reach_v0;
        reach_v0 = _e25.wrapping_mul(2u32);
    }
    for t in 0..256 {
        _e35[t] = m.sums[thread_a0[t].max(1u32).wrapping_sub(1u32) as usize];
    }
    return std::array::from_fn::<_, 256, _>(|t| (if (thread_a0[t] > 0u32) { _e35[t] } else { 0u32 }));
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut own_v0: [u32; 256] = [0u32; 256];
    let mut first_e13: [u32; 256] = [0u32; 256];
    let mut last_e18: [u32; 256] = [0u32; 256];
    let mut _e34: [u32; 256] = [0u32; 256];
    let mut _e35: [u32; 256] = [0u32; 256];
    let _e3 = m.params.buckets;
    let share_e7 = (_e3.wrapping_add(255u32) / 256u32);
    let _e12 = m.params.buckets;
    let _e17 = m.params.buckets;
    for t in 0..256 {
        first_e13[t] = share_e7.wrapping_mul(([t as u32, 0, 0])[0]).min(_e12);
        last_e18[t] = first_e13[t].wrapping_add(share_e7).min(_e17);
        let mut bucket_v1: u32;
        bucket_v1 = first_e13[t];
        'l0: loop {
            'c0: {
                let _e22 = bucket_v1;
                if (_e22 < last_e18[t]) {
                } else {
                    break 'l0;
                }
                {
                    let _e24 = own_v0[t];
                    let _e26 = bucket_v1;
                    let _e28 = <u32>::load(m.tally, 1 * (_e26 as usize));
                    own_v0[t] = _e24.wrapping_add(_e28);
                }
            }
            let _e30 = bucket_v1;
            bucket_v1 = _e30.wrapping_add(1u32);
        }
        _e34[t] = own_v0[t];
    }
    _e35 = sum_before(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e34[t]));
    for t in 0..256 {
        let mut start_v2: u32;
        start_v2 = _e35[t];
        let mut bucket_v3: u32;
        bucket_v3 = first_e13[t];
        'l1: loop {
            'c1: {
                let _e38 = bucket_v3;
                if (_e38 < last_e18[t]) {
                } else {
                    break 'l1;
                }
                {
                    let _e40 = start_v2;
                    let _e42 = bucket_v3;
                    let _e44 = <u32>::load(m.tally, 1 * (_e42 as usize));
                    let end_e45 = _e40.wrapping_add(_e44);
                    let _e47 = bucket_v3;
                    let _e49 = start_v2;
                    Stored::store(Bucket { first: _e49, end: end_e45, colors: 0u32, most: 0u32 }, m.buckets, 4 * (_e47 as usize));
                    start_v2 = end_e45;
                }
            }
            let _e53 = bucket_v3;
            bucket_v3 = _e53.wrapping_add(1u32);
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let tally = bound.read(0);
    let mut buckets = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
        tally: &tally,
        buckets: &mut buckets,
        sums: [0u32; 256],
    };
    for group in 0..bound.workgroups() {
        m.sums = [0u32; 256];
        main(&mut m, group as u32);
    }
}
}
