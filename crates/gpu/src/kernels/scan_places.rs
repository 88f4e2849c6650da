// Written from `shader/buffers/scan_places.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "scan_places",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/shared/scan.wgsl"),
        include_str!("../../shader/shared/entries.wgsl"),
        include_str!("../../shader/buffers/scan_places.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write, Write],
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
use crate::kernels::scan_places::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    blocks: &'a [u32],
    starts: &'a mut [u32],
    control: &'a mut [u32],
    sums: [u32; 256],
}

pub fn saturating_sum(a_a0: u32, b_a1: u32) -> u32 {
    return a_a0.wrapping_add(b_a1.min(4294967295u32.wrapping_sub(a_a0)));
}

pub fn rows_of(m: &mut Memory<'_>, list_a0: u32, most_a1: u32) -> u32 {
    if (list_a0 == 0u32) {
        let _e7 = <u32>::load(m.control, 0);
        return (if (_e7 == 0u32) { 0u32 } else { most_a1 });
    }
    let _e13 = <u32>::load(m.control, 13);
    return _e13.min(most_a1);
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = m.params.list;
    let _e6 = m.params.rows;
    let rows_e7 = rows_of(m, _e3, _e6);
    let mut row_v0: u32;
    row_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = row_v0;
            if (_e10 < rows_e7) {
            } else {
                break 'l0;
            }
            {
                let _e13 = row_v0;
                let _e16 = row_v0;
                let _e18 = <u32>::load(m.starts, 1 * (_e16 as usize));
                let _e20 = row_v0;
                let _e24 = <u32>::load(m.blocks, 1 * ((_e20 / 256u32) as usize));
                let _e25 = saturating_sum(_e18, _e24);
                Stored::store(_e25, m.starts, 1 * (_e13 as usize));
            }
        }
        let _e26 = row_v0;
        row_v0 = _e26.wrapping_add(16776960u32);
    }
    if (([256 * group + t as u32, 0, 0])[0] > 0u32) {
        return;
    }
    let _e34 = m.params.list;
    if (_e34 == 1u32) {
        let _e41 = <u32>::load(m.control, 14);
        Stored::store(_e41, m.starts, 1 * (rows_e7 as usize));
    } else {
        if (rows_e7 > 0u32) {
            let _e48 = <u32>::load(m.control, 13);
            Stored::store(_e48, m.starts, 1 * (rows_e7 as usize));
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let blocks = bound.read(0);
    let mut starts = bound.write(1);
    let mut control = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        blocks: &blocks,
        starts: &mut starts,
        control: &mut control,
        sums: [0u32; 256],
    };
    for group in 0..bound.workgroups() {
        m.sums = [0u32; 256];
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
