// Written from `shader/newton/regrid_positions.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "regrid_positions",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/newton/regrid_positions.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub shift: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::regrid_positions::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    positions: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let _e4 = m.params.shift;
    let half_e9 = [(1u32.wrapping_shl(_e4.wrapping_sub(1u32)) as i32); 3];
    let mut i_v0: u32;
    i_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e12 = i_v0;
            let _e15 = m.params.nodes;
            if (_e12 < _e15) {
            } else {
                break 'l0;
            }
            {
                let _e18 = i_v0;
                let _e21 = i_v0;
                let _e23 = <[i32; 4]>::load(m.positions, 4 * (_e21 as usize));
                let _e28 = m.params.shift;
                let _e30 = zip(zip(swizzle(_e23, [0, 1, 2]), half_e9, |x, y| x.wrapping_add(y)), [_e28; 3], |x, y| x.wrapping_shr(y));
                Stored::store([(_e30)[0], (_e30)[1], (_e30)[2], 0i32], m.positions, 4 * (_e18 as usize));
            }
        }
        let _e33 = i_v0;
        i_v0 = _e33.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let mut positions = bound.write(0);
    let mut m = Memory {
        params: bound.params(),
        positions: &mut positions,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
