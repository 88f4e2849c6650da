// Written from `shader/newton/subtract_known_forces.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "subtract_known_forces",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/newton/subtract_known_forces.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub count: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::subtract_known_forces::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    nodes: &'a [u32],
    forces: &'a [u32],
    gradient: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut k_v0: u32;
    k_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = k_v0;
            let _e6 = m.params.count;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = k_v0;
                let i_e11 = <u32>::load(m.nodes, 1 * (_e9 as usize));
                let _e16 = <[f32; 4]>::load(m.gradient, 4 * (i_e11 as usize));
                let _e19 = k_v0;
                let _e21 = <[f32; 4]>::load(m.forces, 4 * (_e19 as usize));
                let _e23 = zip(swizzle(_e16, [0, 1, 2]), swizzle(_e21, [0, 1, 2]), |x, y| (x - y));
                Stored::store([(_e23)[0], (_e23)[1], (_e23)[2], 0.0f32], m.gradient, 4 * (i_e11 as usize));
            }
        }
        let _e26 = k_v0;
        k_v0 = _e26.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let nodes = bound.read(0);
    let forces = bound.read(1);
    let mut gradient = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        nodes: &nodes,
        forces: &forces,
        gradient: &mut gradient,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
