// Written from `shader/rows/previous_displacements.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "previous_displacements",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/rows/previous_displacements.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write, Write],
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
    pub vertices: u32,
    pub table: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::previous_displacements::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    aims: &'a [u32],
    displacements: &'a mut [u32],
    table: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut v_v0: u32;
    v_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = v_v0;
            let _e6 = m.params.vertices;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = v_v0;
                let _e12 = v_v0;
                let _e14 = <[i32; 4]>::load(m.aims, 4 * (_e12 as usize));
                let _e17 = v_v0;
                let _e19 = <[i32; 4]>::load(m.positions, 4 * (_e17 as usize));
                let _e22 = zip(swizzle(_e14, [0, 1, 2]), swizzle(_e19, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                Stored::store([(_e22)[0], (_e22)[1], (_e22)[2], 0.0f32], m.displacements, 4 * (_e9 as usize));
            }
        }
        let _e25 = v_v0;
        v_v0 = _e25.wrapping_add(16776960u32);
    }
    let mut place_v1: u32;
    place_v1 = ([256 * group + t as u32, 0, 0])[0];
    'l1: loop {
        'c1: {
            let _e30 = place_v1;
            let _e33 = m.params.table;
            if (_e30 < _e33) {
            } else {
                break 'l1;
            }
            {
                let _e36 = place_v1;
                Stored::store(4294967295u32, m.table, 1 * (_e36 as usize));
            }
        }
        let _e39 = place_v1;
        place_v1 = _e39.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let aims = bound.read(1);
    let mut displacements = bound.write(2);
    let mut table = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        aims: &aims,
        displacements: &mut displacements,
        table: &mut table,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
