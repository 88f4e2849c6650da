// Written from `shader/backward/sort_rows.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "sort_rows",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/sort_rows.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write, Write],
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
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::sort_rows::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    rows: &'a [u32],
    buckets: &'a [u32],
    tally: &'a mut [u32],
    order: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.control, 14);
    let _e6 = m.params.capacity;
    let count_e7 = _e3.min(_e6);
    let mut r_v0: u32;
    r_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e10 = r_v0;
            if (_e10 < count_e7) {
            } else {
                break 'l0;
            }
            {
                let _e13 = r_v0;
                let bucket_e16 = <u32>::load(m.rows, 24 * (_e13 as usize) + 23);
                let _e21 = <u32>::load(m.buckets, 4 * (bucket_e16 as usize));
                let _e25 = { let old = <u32>::load(m.tally, 1 * (bucket_e16 as usize)); let new = old.wrapping_sub(1u32); Stored::store(new, m.tally, 1 * (bucket_e16 as usize)); old };
                let _e30 = r_v0;
                Stored::store(_e30, m.order, 1 * (_e21.wrapping_add(_e25).wrapping_sub(1u32) as usize));
            }
        }
        let _e31 = r_v0;
        r_v0 = _e31.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let rows = bound.read(0);
    let buckets = bound.read(1);
    let mut tally = bound.write(2);
    let mut order = bound.write(3);
    let mut control = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        rows: &rows,
        buckets: &buckets,
        tally: &mut tally,
        order: &mut order,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
