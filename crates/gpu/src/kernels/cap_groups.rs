// Written from `shader/forward/cap_groups.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "cap_groups",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/forward/cap_groups.wgsl"),
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
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::cap_groups::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    vertices: &'a [u32],
    group_caps: &'a [u32],
    paths: &'a mut [u32],
    alphas: &'a mut [u32],
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
                let _e14 = v_v0;
                let _e16 = <[f32; 4]>::load(m.paths, 4 * (_e14 as usize));
                let mut path_v1: [f32; 4];
                path_v1 = _e16;
                if (group_e12 != 4294967295u32) {
                    let _e22 = <u32>::load(m.group_caps, 1 * (group_e12 as usize));
                    let cap_e23 = f32::from_bits(_e22 as u32);
                    let _e25 = path_v1[3];
                    if (cap_e23 < _e25) {
                        let _e27 = path_v1;
                        let _e30 = path_v1[3];
                        let _e32 = swizzle(_e27, [0, 1, 2]).map(|x| (x * (cap_e23 / _e30)));
                        path_v1 = [(_e32)[0], (_e32)[1], (_e32)[2], cap_e23];
                        let _e35 = v_v0;
                        let _e37 = path_v1;
                        Stored::store(_e37, m.paths, 4 * (_e35 as usize));
                    }
                }
                let _e39 = v_v0;
                let _e42 = path_v1[3];
                Stored::store(_e42.to_bits(), m.alphas, 1 * (_e39 as usize));
            }
        }
        let _e44 = v_v0;
        v_v0 = _e44.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let vertices = bound.read(0);
    let group_caps = bound.read(1);
    let mut paths = bound.write(2);
    let mut alphas = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        vertices: &vertices,
        group_caps: &group_caps,
        paths: &mut paths,
        alphas: &mut alphas,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
