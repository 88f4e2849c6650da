// Written from `shader/backward/coarse_rescale.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "coarse_rescale",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/coarse_rescale.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Write, Write, Read, Read, Read, Write, Write],
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
    pub limits: u32,
    pub vertices: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::coarse_rescale::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    factor: &'a [u32],
    rows: &'a mut [u32],
    limits: &'a mut [u32],
    positions: &'a [u32],
    targets: &'a [u32],
    vertices: &'a [u32],
    displacements: &'a mut [u32],
    control: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let s_e3 = <f32>::load(m.factor, 0);
    let mut r_v0: u32;
    r_v0 = ([256 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e7 = r_v0;
            let _e10 = <u32>::load(m.control, 14);
            let _e13 = m.params.capacity;
            if (_e7 < _e10.min(_e13)) {
            } else {
                break 'l0;
            }
            {
                let _e17 = r_v0;
                let _e20 = <f32>::load(m.rows, 24 * (_e17 as usize) + 13);
                Stored::store((_e20 * s_e3), m.rows, 24 * (_e17 as usize) + 13);
                let _e23 = r_v0;
                let _e26 = <[f32; 3]>::load(m.rows, 24 * (_e23 as usize) + 20);
                Stored::store(_e26.map(|x| (x * s_e3)), m.rows, 24 * (_e23 as usize) + 20);
            }
        }
        let _e28 = r_v0;
        r_v0 = _e28.wrapping_add(16776960u32);
    }
    let mut e_v1: u32;
    e_v1 = ([256 * group + t as u32, 0, 0])[0];
    'l1: loop {
        'c1: {
            let _e32 = e_v1;
            let _e35 = m.params.limits;
            if (_e32 < _e35) {
            } else {
                break 'l1;
            }
            {
                let _e38 = e_v1;
                let _e41 = <[f32; 3]>::load(m.limits, 8 * (_e38 as usize) + 4);
                Stored::store(_e41.map(|x| (x * s_e3)), m.limits, 8 * (_e38 as usize) + 4);
            }
        }
        let _e43 = e_v1;
        e_v1 = _e43.wrapping_add(16776960u32);
    }
    let mut v_v2: u32;
    v_v2 = ([256 * group + t as u32, 0, 0])[0];
    'l2: loop {
        'c2: {
            let _e47 = v_v2;
            let _e50 = m.params.vertices;
            if (_e47 < _e50) {
            } else {
                break 'l2;
            }
            {
                let _e53 = v_v2;
                let displacement_e55 = <[f32; 4]>::load(m.displacements, 4 * (_e53 as usize));
                if ((displacement_e55)[3] > 0.0f32) {
                    let _e60 = v_v2;
                    let _e62 = <[i32; 4]>::load(m.targets, 4 * (_e60 as usize));
                    let _e65 = v_v2;
                    let _e67 = <[i32; 4]>::load(m.positions, 4 * (_e65 as usize));
                    let wanted_e70 = zip(swizzle(_e62, [0, 1, 2]), swizzle(_e67, [0, 1, 2]), |x, y| x.wrapping_sub(y)).map(|x| (x as f32));
                    let _e73 = v_v2;
                    let _e76 = <f32>::load(m.vertices, 12 * (_e73 as usize) + 10);
                    let free_e78 = wanted_e70.map(|x| (x * ((displacement_e55)[3] * _e76)));
                    let _e80 = v_v2;
                    let _e85 = zip(free_e78, zip(swizzle(displacement_e55, [0, 1, 2]), free_e78, |x, y| (x - y)).map(|x| (s_e3 * x)), |x, y| (x + y));
                    let _e86 = (displacement_e55)[3];
                    Stored::store([(_e85)[0], (_e85)[1], (_e85)[2], _e86], m.displacements, 4 * (_e80 as usize));
                }
            }
        }
        let _e88 = v_v2;
        v_v2 = _e88.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let factor = bound.read(0);
    let mut rows = bound.write(1);
    let mut limits = bound.write(2);
    let positions = bound.read(3);
    let targets = bound.read(4);
    let vertices = bound.read(5);
    let mut displacements = bound.write(6);
    let mut control = bound.write(7);
    let mut m = Memory {
        params: bound.params(),
        factor: &factor,
        rows: &mut rows,
        limits: &mut limits,
        positions: &positions,
        targets: &targets,
        vertices: &vertices,
        displacements: &mut displacements,
        control: &mut control,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
