// Written from `shader/call/reset_step.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "reset_step",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/call/reset_step.wgsl"),
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

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub groups: u32,
    pub again: u32,
    pub first: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::reset_step::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    group_caps: &'a mut [u32],
    group_alphas: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut g_v0: u32;
    g_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = g_v0;
            let _e6 = m.params.groups;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = g_v0;
                Stored::store(1.0f32, m.group_caps, 1 * (_e9 as usize));
                let _e13 = g_v0;
                Stored::store(1.0f32, m.group_alphas, 1 * (_e13 as usize));
            }
        }
        let _e16 = g_v0;
        g_v0 = _e16.wrapping_add(16776960u32);
    }
    if (([256 * group + t as u32, 0, 0])[0] > 0u32) {
        return;
    }
    Stored::store(0u32, m.control, 1);
    Stored::store(0u32, m.control, 2);
    Stored::store(0u32, m.control, 3);
    Stored::store(0u32, m.control, 4);
    Stored::store(0u32, m.control, 5);
    Stored::store(0u32, m.control, 6);
    Stored::store(0u32, m.control, 7);
    Stored::store(0u32, m.control, 8);
    Stored::store(0u32, m.control, 9);
    Stored::store(0u32, m.control, 10);
    Stored::store(0u32, m.control, 11);
    let _e57 = m.params.again;
    if (_e57 == 0u32) {
        Stored::store(0u32, m.control, 0);
        Stored::store(0u32, m.control, 12);
    }
    let _e68 = m.params.first;
    if (_e68 != 0u32) {
        Stored::store(0u32, m.control, 15);
        Stored::store(0u32, m.control, 16);
    }
}

pub fn run(bound: Bound<'_>) {
    let mut group_caps = bound.write(0);
    let mut group_alphas = bound.write(1);
    let mut control = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        group_caps: &mut group_caps,
        group_alphas: &mut group_alphas,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
