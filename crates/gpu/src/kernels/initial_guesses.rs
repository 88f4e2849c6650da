// Written from `shader/newton/initial_guesses.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "initial_guesses",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/free.wgsl"),
        include_str!("../../shader/newton/initial_guesses.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub count: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::initial_guesses::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    iterate: &'a [u32],
    inertial: &'a [u32],
    last: &'a [u32],
    free: &'a [u32],
    direction: &'a mut [u32],
    second: &'a mut [u32],
}

pub fn is_free(m: &mut Memory<'_>, i_a0: u32) -> bool {
    let _e5 = <u32>::load(m.free, 1 * ((i_a0 / 32u32) as usize));
    return ((_e5.wrapping_shr((i_a0 % 32u32)) & 1u32) == 1u32);
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut i_v0: u32;
    i_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = i_v0;
            let _e6 = m.params.nodes;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let mut by_inertia_v1: [f32; 3];
                by_inertia_v1 = [0.0f32; 3];
                let mut back_v2: [f32; 3];
                back_v2 = [0.0f32; 3];
                let _e14 = i_v0;
                let _e15 = is_free(m, _e14);
                if _e15 {
                    let _e17 = i_v0;
                    let _e19 = <[i32; 4]>::load(m.iterate, 4 * (_e17 as usize));
                    let x_e20 = swizzle(_e19, [0, 1, 2]);
                    let _e22 = i_v0;
                    let _e24 = <[i32; 4]>::load(m.inertial, 4 * (_e22 as usize));
                    let _e30 = m.params.quantum;
                    by_inertia_v1 = zip(swizzle(_e24, [0, 1, 2]), x_e20, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e30));
                    let _e34 = m.params.count;
                    if (_e34 == 2u32) {
                        let _e38 = i_v0;
                        let _e40 = <[i32; 4]>::load(m.last, 4 * (_e38 as usize));
                        let _e46 = m.params.quantum;
                        back_v2 = zip(swizzle(_e40, [0, 1, 2]), x_e20, |x, y| x.wrapping_sub(y)).map(|x| (x as f32)).map(|x| (x * _e46));
                    }
                }
                let _e50 = m.params.count;
                if (_e50 == 2u32) {
                    let _e54 = i_v0;
                    let _e56 = back_v2;
                    Stored::store([(_e56)[0], (_e56)[1], (_e56)[2], 0.0f32], m.direction, 4 * (_e54 as usize));
                    let _e60 = i_v0;
                    let _e62 = by_inertia_v1;
                    Stored::store([(_e62)[0], (_e62)[1], (_e62)[2], 0.0f32], m.second, 4 * (_e60 as usize));
                } else {
                    let _e66 = i_v0;
                    let _e68 = by_inertia_v1;
                    Stored::store([(_e68)[0], (_e68)[1], (_e68)[2], 0.0f32], m.direction, 4 * (_e66 as usize));
                }
            }
        }
        let _e71 = i_v0;
        i_v0 = _e71.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let iterate = bound.read(0);
    let inertial = bound.read(1);
    let last = bound.read(2);
    let free = bound.read(3);
    let mut direction = bound.write(4);
    let mut second = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        iterate: &iterate,
        inertial: &inertial,
        last: &last,
        free: &free,
        direction: &mut direction,
        second: &mut second,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
