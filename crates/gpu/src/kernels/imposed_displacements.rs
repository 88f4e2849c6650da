// Written from `shader/newton/imposed_displacements.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "imposed_displacements",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/newton/imposed_displacements.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub quantum: f32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::imposed_displacements::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    imposed: &'a [u32],
    direction: &'a mut [u32],
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
                let _e9 = i_v0;
                let _e12 = i_v0;
                let _e14 = <[i32; 4]>::load(m.imposed, 4 * (_e12 as usize));
                let _e19 = m.params.quantum;
                let _e20 = swizzle(_e14, [0, 1, 2]).map(|x| (x as f32)).map(|x| (x * _e19));
                Stored::store([(_e20)[0], (_e20)[1], (_e20)[2], 0.0f32], m.direction, 4 * (_e9 as usize));
            }
        }
        let _e23 = i_v0;
        i_v0 = _e23.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let imposed = bound.read(0);
    let mut direction = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
        imposed: &imposed,
        direction: &mut direction,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
