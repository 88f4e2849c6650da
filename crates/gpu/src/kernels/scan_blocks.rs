// Written from `shader/buffers/scan_blocks.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "scan_blocks",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/scan.wgsl"),
        include_str!("../../shader/shared/entries.wgsl"),
        include_str!("../../shader/buffers/scan_blocks.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Write, Write],
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
    pub blocks: u32,
    pub capacity: u32,
    pub list: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::scan_blocks::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    blocks: &'a mut [u32],
    control: &'a mut [u32],
    sums: [u32; 256],
    shared_blocks: u32,
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
    let mut own_v1: [u32; 256] = [0u32; 256];
    let mut _e34: [bool; 256] = [false; 256];
    let mut first_e41: [u32; 256] = [0u32; 256];
    let mut end_e43: [u32; 256] = [0u32; 256];
    let mut _e59: [u32; 256] = [0u32; 256];
    let mut _e60: [u32; 256] = [0u32; 256];
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e7 = m.params.list;
            let _e11 = m.params.blocks;
            let _e13 = rows_of(m, _e7, 256u32.wrapping_mul(_e11));
            let _e20 = m.params.blocks;
            m.shared_blocks = (_e13.wrapping_add(255u32) / 256u32).min(_e20);
        }
    }
    let count_e23 = { let t = 0; m.shared_blocks };
    let _e26 = m.params.list;
    for t in 0..256 {
        let mut local_v0: bool;
        if (_e26 == 0u32) {
            local_v0 = (count_e23 == 0u32);
        } else {
            local_v0 = false;
        }
        _e34[t] = local_v0;
    }
    if uniform(std::array::from_fn::<_, 256, _>(|t| _e34[t])) {
        return;
    }
    let share_e38 = (count_e23.wrapping_add(255u32) / 256u32);
    for t in 0..256 {
        first_e41[t] = share_e38.wrapping_mul(([t as u32, 0, 0])[0]).min(count_e23);
        end_e43[t] = first_e41[t].wrapping_add(share_e38).min(count_e23);
        let mut block_v2: u32;
        block_v2 = first_e41[t];
        'l0: loop {
            'c0: {
                let _e47 = block_v2;
                if (_e47 < end_e43[t]) {
                } else {
                    break 'l0;
                }
                {
                    let _e49 = own_v1[t];
                    let _e51 = block_v2;
                    let _e53 = <u32>::load(m.blocks, 1 * (_e51 as usize));
                    let _e54 = saturating_sum(_e49, _e53);
                    own_v1[t] = _e54;
                }
            }
            let _e55 = block_v2;
            block_v2 = _e55.wrapping_add(1u32);
        }
        _e59[t] = own_v1[t];
    }
    _e60 = sum_before(m, std::array::from_fn::<_, 256, _>(|t| ([t as u32, 0, 0])[0]), std::array::from_fn::<_, 256, _>(|t| _e59[t]));
    for t in 0..256 {
        let mut start_v3: u32;
        start_v3 = _e60[t];
        let mut block_v4: u32;
        block_v4 = first_e41[t];
        'l1: loop {
            'c1: {
                let _e63 = block_v4;
                if (_e63 < end_e43[t]) {
                } else {
                    break 'l1;
                }
                {
                    let _e66 = block_v4;
                    let entries_e68 = <u32>::load(m.blocks, 1 * (_e66 as usize));
                    let _e70 = block_v4;
                    let _e72 = start_v3;
                    Stored::store(_e72, m.blocks, 1 * (_e70 as usize));
                    let _e73 = start_v3;
                    let _e74 = saturating_sum(_e73, entries_e68);
                    start_v3 = _e74;
                }
            }
            let _e75 = block_v4;
            block_v4 = _e75.wrapping_add(1u32);
        }
        if (([t as u32, 0, 0])[0] == 0u32) {
            let total_e83 = m.sums[255];
            let _e86 = m.params.list;
            if (_e86 == 0u32) {
                Stored::store(total_e83, m.control, 13);
            } else {
                Stored::store(total_e83, m.control, 14);
            }
            let _e95 = m.params.capacity;
            if (total_e83 > _e95) {
                Stored::store(1u32, m.control, 1);
            }
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let mut blocks = bound.write(0);
    let mut control = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
        blocks: &mut blocks,
        control: &mut control,
        sums: [0u32; 256],
        shared_blocks: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.sums = [0u32; 256];
        m.shared_blocks = 0u32;
        main(&mut m, group as u32);
    }
}
}
