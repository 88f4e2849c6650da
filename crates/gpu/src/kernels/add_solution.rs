// Written from `shader/newton/add_solution.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "add_solution",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/shared/newton.wgsl"),
        include_str!("../../shader/newton/add_solution.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Write, Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub last: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::add_solution::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    solution: &'a [u32],
    progress: &'a mut [u32],
    ended: &'a mut [u32],
    solve: &'a mut [u32],
    step: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = m.params.last;
    let mut local_v0: bool;
    if (!(_e3 == 1u32)) {
        let _e11 = <u32>::load(m.progress, 0);
        local_v0 = (_e11 == 0u32);
    } else {
        local_v0 = true;
    }
    let ends_e15 = local_v0;
    if (([64 * group + t as u32, 0, 0])[0] == 0u32) {
        Stored::store((if ends_e15 { 1u32 } else { 0u32 }), m.ended, 0);
        Stored::store((if ends_e15 { 1u32 } else { 0u32 }), m.solve, 8);
    }
    if (!ends_e15) {
        return;
    }
    let inverse_e32 = <f32>::load(m.solve, 1);
    let mut i_v1: u32;
    i_v1 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e35 = i_v1;
            let _e38 = m.params.nodes;
            if (_e35 < _e38) {
            } else {
                break 'l0;
            }
            {
                let _e41 = i_v1;
                let _e44 = i_v1;
                let _e46 = <[f32; 4]>::load(m.step, 4 * (_e44 as usize));
                let _e49 = i_v1;
                let _e51 = <[f32; 4]>::load(m.solution, 4 * (_e49 as usize));
                let _e54 = zip(swizzle(_e46, [0, 1, 2]), swizzle(_e51, [0, 1, 2]).map(|x| (inverse_e32 * x)), |x, y| (x + y));
                Stored::store([(_e54)[0], (_e54)[1], (_e54)[2], 0.0f32], m.step, 4 * (_e41 as usize));
            }
        }
        let _e57 = i_v1;
        i_v1 = _e57.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let solution = bound.read(0);
    let mut progress = bound.write(1);
    let mut ended = bound.write(2);
    let mut solve = bound.write(3);
    let mut step = bound.write(4);
    let mut m = Memory {
        params: bound.params(),
        solution: &solution,
        progress: &mut progress,
        ended: &mut ended,
        solve: &mut solve,
        step: &mut step,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
