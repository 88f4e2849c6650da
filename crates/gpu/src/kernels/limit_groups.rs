// Written from `shader/forward/limit_groups.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "limit_groups",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/forward/limit_groups.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Write],
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
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::limit_groups::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    vertices: &'a [u32],
    alphas: &'a [u32],
    group_alphas: &'a mut [u32],
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
                let group_e12 = <u32>::load(m.vertices, 12 * (_e9 as usize) + 6);
                if (group_e12 != 4294967295u32) {
                    let _e18 = v_v0;
                    let _e20 = <u32>::load(m.alphas, 1 * (_e18 as usize));
                    { let old = <u32>::load(m.group_alphas, 1 * (group_e12 as usize)); let new = old.min(_e20); Stored::store(new, m.group_alphas, 1 * (group_e12 as usize)); old };
                }
            }
        }
        let _e22 = v_v0;
        v_v0 = _e22.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let vertices = bound.read(0);
    let alphas = bound.read(1);
    let mut group_alphas = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        vertices: &vertices,
        alphas: &alphas,
        group_alphas: &mut group_alphas,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
