// Written from `shader/buffers/scan_counts.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "scan_counts",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/scan.wgsl"),
        include_str!("../../shader/shared/entries.wgsl"),
        include_str!("../../shader/buffers/scan_counts.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Write, Write, Write],
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
pub const CANDIDATES: u32 = 0u32;
pub const CONTACT_ROWS: u32 = 1u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub rows: u32,
    pub list: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::scan_counts::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    starts: &'a mut [u32],
    blocks: &'a mut [u32],
    control: &'a mut [u32],
    sums: [u32; 256],
    shared_rows: u32,
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

pub fn rows_of(m: &mut Memory<'_>, list_a0: u32, most_a1: u32) -> u32 {
    if (list_a0 == 0u32) {
        let _e7 = <u32>::load(m.control, 0);
        return (if (_e7 == 0u32) { 0u32 } else { most_a1 });
    }
    let _e13 = <u32>::load(m.control, 13);
    return _e13.min(most_a1);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut block_v0: u32 = 0u32;
    let mut row_e25: [u32; 256] = [0u32; 256];
    let mut _e33: [u32; 256] = [0u32; 256];
    let mut before_e34: [u32; 256] = [0u32; 256];
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e8 = m.params.list;
            let _e11 = m.params.rows;
            let _e12 = rows_of(m, _e8, _e11);
            m.shared_rows = _e12;
        }
    }
    let rows_e14 = { let t = 0; m.shared_rows };
    block_v0 = ([group, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e18 = block_v0;
            if (256u32.wrapping_mul(_e18) < rows_e14) {
            } else {
                break 'l0;
            }
            {
                let _e22 = block_v0;
                for t in 0..256 {
                    row_e25[t] = 256u32.wrapping_mul(_e22).wrapping_add(([t as u32, 0, 0])[0]);
                    let mut count_v1: u32;
                    count_v1 = 0u32;
                    if (row_e25[t] < rows_e14) {
                        let _e31 = <u32>::load(m.starts, 1 * (row_e25[t] as usize));
                        count_v1 = _e31;
                    }
                    _e33[t] = count_v1;
                }
                before_e34 = sum_before(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e33[t]));
                for t in 0..256 {
                    if (row_e25[t] < rows_e14) {
                        Stored::store(before_e34[t], m.starts, 1 * (row_e25[t] as usize));
                    }
                    if (([t as u32, 0, 0])[0] == 255u32) {
                        let _e42 = block_v0;
                        let _e46 = m.sums[255];
                        Stored::store(_e46, m.blocks, 1 * (_e42 as usize));
                    }
                }
            }
        }
        let _e47 = block_v0;
        block_v0 = _e47.wrapping_add(65535u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let mut starts = bound.write(0);
    let mut blocks = bound.write(1);
    let mut control = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        starts: &mut starts,
        blocks: &mut blocks,
        control: &mut control,
        sums: [0u32; 256],
        shared_rows: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.sums = [0u32; 256];
        m.shared_rows = 0u32;
        main(&mut m, group as u32);
    }
}
}
