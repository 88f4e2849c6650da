// Written from `shader/backward/set_aims.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "set_aims",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/backward/set_aims.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Read, Read, Read, Write, Write],
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
pub const BORDER: i32 = 536870911i32;
pub const GROWTH: f32 = 2.0f32;
pub const DECAY: f32 = 0.8f32;
pub const FARTHEST: f32 = 1073741800.0f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub vertices: u32,
    pub growth: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::set_aims::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    positions: &'a [u32],
    targets: &'a [u32],
    displacements: &'a [u32],
    aims: &'a mut [u32],
    swings: &'a mut [u32],
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
                let displacement_e11 = <[f32; 4]>::load(m.displacements, 4 * (_e9 as usize));
                let _e13 = v_v0;
                let _e15 = <[i32; 4]>::load(m.positions, 4 * (_e13 as usize));
                let position_e16 = swizzle(_e15, [0, 1, 2]);
                let mut aim_v1: [i32; 3];
                aim_v1 = position_e16;
                if ((displacement_e11)[3] == 0.0f32) {
                    let _e22 = v_v0;
                    let _e24 = <[i32; 4]>::load(m.targets, 4 * (_e22 as usize));
                    aim_v1 = swizzle(_e24, [0, 1, 2]);
                } else {
                    let size_e30 = zip(swizzle(displacement_e11, [0, 1, 2]).map(|x| x.to_bits()), [2147483647u32; 3], |x, y| (x & y));
                    if all(zip(size_e30, [1073741800.0f32.to_bits(); 3], |x, y| (x <= y))) {
                        let near_e40 = zip(zip(position_e16, [(-536870911i32); 3], |x, y| x.max(y)), [536870911i32; 3], |x, y| x.min(y));
                        let moved_e43 = swizzle(displacement_e11, [0, 1, 2]).map(|x| x.round_ties_even()).map(|x| (x as i32));
                        aim_v1 = zip(zip(zip(near_e40, moved_e43, |x, y| x.wrapping_add(y)), [(-536870911i32); 3], |x, y| x.max(y)), [536870911i32; 3], |x, y| x.min(y));
                    }
                }
                let _e51 = v_v0;
                let _e53 = aim_v1;
                Stored::store([(_e53)[0], (_e53)[1], (_e53)[2], 0i32], m.aims, 4 * (_e51 as usize));
                let _e57 = v_v0;
                let last_e59 = <[f32; 4]>::load(m.swings, 4 * (_e57 as usize));
                let turn_e62 = dot(swizzle(displacement_e11, [0, 1, 2]), swizzle(last_e59, [0, 1, 2]));
                let mut factor_v2: f32;
                factor_v2 = (last_e59)[3];
                if (turn_e62 < 0.0f32) {
                    let _e67 = factor_v2;
                    let _e72 = m.params.growth;
                    factor_v2 = (_e67 * 2.0f32).min(_e72);
                } else {
                    if (turn_e62 > 0.0f32) {
                        let _e76 = factor_v2;
                        factor_v2 = (_e76 * 0.8f32).max(1.0f32);
                    }
                }
                let _e82 = v_v0;
                let _e84 = swizzle(displacement_e11, [0, 1, 2]);
                let _e85 = factor_v2;
                let _e87 = _e85.max(1.0f32);
                Stored::store([(_e84)[0], (_e84)[1], (_e84)[2], _e87], m.swings, 4 * (_e82 as usize));
            }
        }
        let _e89 = v_v0;
        v_v0 = _e89.wrapping_add(16776960u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let positions = bound.read(0);
    let targets = bound.read(1);
    let displacements = bound.read(2);
    let mut aims = bound.write(3);
    let mut swings = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        positions: &positions,
        targets: &targets,
        displacements: &displacements,
        aims: &mut aims,
        swings: &mut swings,
    };
    for group in 0..bound.workgroups() {
        for t in 0..256 {
            main(&mut m, group as u32, t);
        }
    }
}
}
