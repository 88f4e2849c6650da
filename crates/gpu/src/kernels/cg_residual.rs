// Written from `shader/newton/cg_residual.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "cg_residual",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/newton.wgsl"),
        include_str!("../../shader/newton/cg_residual.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub subtract: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::cg_residual::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    right_side: &'a [u32],
    image: &'a [u32],
    solve: &'a [u32],
    direction: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e3 = <u32>::load(m.solve, 8);
    if (_e3 == 0u32) {
        return;
    }
    let mut i_v0: u32;
    i_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e8 = i_v0;
            let _e11 = m.params.nodes;
            if (_e8 < _e11) {
            } else {
                break 'l0;
            }
            {
                let _e14 = i_v0;
                let b_e16 = <[f32; 4]>::load(m.right_side, 4 * (_e14 as usize));
                let mut r_v1: [f32; 3];
                r_v1 = [0.0f32; 3];
                if ((b_e16)[3] == 1.0f32) {
                    r_v1 = swizzle(b_e16, [0, 1, 2]);
                    let _e26 = m.params.subtract;
                    if (_e26 == 1u32) {
                        let _e29 = r_v1;
                        let _e31 = i_v0;
                        let _e33 = <[f32; 4]>::load(m.image, 4 * (_e31 as usize));
                        r_v1 = zip(_e29, swizzle(_e33, [0, 1, 2]), |x, y| (x - y));
                    }
                    let _e36 = r_v1;
                    let _e39 = <f32>::load(m.solve, 0);
                    r_v1 = _e36.map(|x| (x * _e39));
                }
                let _e42 = i_v0;
                let _e44 = r_v1;
                Stored::store([(_e44)[0], (_e44)[1], (_e44)[2], 0.0f32], m.direction, 4 * (_e42 as usize));
            }
        }
        let _e47 = i_v0;
        i_v0 = _e47.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let right_side = bound.read(0);
    let image = bound.read(1);
    let solve = bound.read(2);
    let mut direction = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        right_side: &right_side,
        image: &image,
        solve: &solve,
        direction: &mut direction,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
