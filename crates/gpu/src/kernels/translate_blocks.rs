// Written from `shader/newton/translate_blocks.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "translate_blocks",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/free.wgsl"),
        include_str!("../../shader/newton/translate_blocks.wgsl"),
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
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::translate_blocks::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    blocks: &'a [u32],
    translations: &'a [u32],
    free: &'a [u32],
    step: &'a mut [u32],
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
                let _e8 = i_v0;
                let _e9 = is_free(m, _e8);
                if _e9 {
                    let _e11 = i_v0;
                    let _e14 = i_v0;
                    let _e16 = <[f32; 4]>::load(m.step, 4 * (_e14 as usize));
                    let _e20 = i_v0;
                    let _e22 = <u32>::load(m.blocks, 1 * (_e20 as usize));
                    let _e24 = <[f32; 4]>::load(m.translations, 4 * (_e22 as usize));
                    let _e26 = zip(swizzle(_e16, [0, 1, 2]), swizzle(_e24, [0, 1, 2]), |x, y| (x + y));
                    Stored::store([(_e26)[0], (_e26)[1], (_e26)[2], 0.0f32], m.step, 4 * (_e11 as usize));
                }
            }
        }
        let _e29 = i_v0;
        i_v0 = _e29.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let blocks = bound.read(0);
    let translations = bound.read(1);
    let free = bound.read(2);
    let mut step = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        blocks: &blocks,
        translations: &translations,
        free: &free,
        step: &mut step,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
