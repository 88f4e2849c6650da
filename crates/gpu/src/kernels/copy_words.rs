// Written from `shader/buffers/copy_words.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "copy_words",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/buffers/copy_words.wgsl"),
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
    pub words: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::copy_words::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    source: &'a [u32],
    copy: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut i_v0: u32;
    i_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = i_v0;
            let _e6 = m.params.words;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = i_v0;
                let _e12 = i_v0;
                let _e14 = <u32>::load(m.source, 1 * (_e12 as usize));
                Stored::store(_e14, m.copy, 1 * (_e9 as usize));
            }
        }
        let _e15 = i_v0;
        i_v0 = _e15.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let source = bound.read(0);
    let mut copy = bound.write(1);
    let mut m = Memory {
        params: bound.params(),
        source: &source,
        copy: &mut copy,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
