// Written from `shader/backward/store_multipliers.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "store_multipliers",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/store_multipliers.wgsl"),
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub capacity: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::store_multipliers::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    rows: &'a [u32],
    states: &'a mut [u32],
    control: &'a mut [u32],
    shared_pressing: u32,
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    let mut pressing_v0: [u32; 256] = [0u32; 256];
    let _e7 = m.params.capacity;
    for t in 0..256 {
        let _e4 = <u32>::load(m.control, 14);
        let count_e8 = _e4.min(_e7);
        let mut r_v1: u32;
        r_v1 = ([256 * group + t as u32, 0, 0])[0];
        'l0: loop {
            'c0: {
                let _e13 = r_v1;
                if (_e13 < count_e8) {
                } else {
                    break 'l0;
                }
                {
                    let _e17 = r_v1;
                    let _e20 = <u32>::load(m.rows, 24 * (_e17 as usize) + 14);
                    let _e24 = r_v1;
                    let _e27 = <f32>::load(m.rows, 24 * (_e24 as usize) + 13);
                    Stored::store(_e27, m.states, 8 * (_e20 as usize) + 3);
                    let _e28 = pressing_v0[t];
                    let _e30 = r_v1;
                    let _e33 = <f32>::load(m.rows, 24 * (_e30 as usize) + 13);
                    pressing_v0[t] = _e28.wrapping_add(u32::from((_e33 > 0.0f32)));
                    let _e40 = r_v1;
                    let _e43 = <u32>::load(m.rows, 24 * (_e40 as usize) + 14);
                    let _e47 = r_v1;
                    let _e50 = <[f32; 3]>::load(m.rows, 24 * (_e47 as usize) + 20);
                    Stored::store(_e50, m.states, 8 * (_e43 as usize));
                }
            }
            let _e51 = r_v1;
            r_v1 = _e51.wrapping_add(16776960u32);
        }
        let _e54 = pressing_v0[t];
        if (_e54 > 0u32) {
            let _e58 = pressing_v0[t];
            { let old = m.shared_pressing; let new = old.wrapping_add(_e58); m.shared_pressing = new; old };
        }
    }
    for t in 0..256 {
        let mut local_v2: bool;
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e66 = m.shared_pressing;
            local_v2 = (_e66 > 0u32);
        } else {
            local_v2 = false;
        }
        let _e70 = local_v2;
        if _e70 {
            let _e74 = m.shared_pressing;
            { let old = <u32>::load(m.control, 12); let new = old.wrapping_add(_e74); Stored::store(new, m.control, 12); old };
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let rows = bound.read(0);
    let mut states = bound.write(1);
    let mut control = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        rows: &rows,
        states: &mut states,
        control: &mut control,
        shared_pressing: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.shared_pressing = 0u32;
        main(&mut m, group as u32);
    }
}
}
