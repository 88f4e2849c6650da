// Written from `shader/buffers/gather_nodes.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "gather_nodes",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/buffers/gather_nodes.wgsl"),
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
    pub nodes: u32,
    pub width: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::gather_nodes::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    nodes: &'a [u32],
    source: &'a [u32],
    copy: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut k_v0: u32;
    k_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = k_v0;
            let _e6 = m.params.nodes;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let mut word_v1: u32;
                word_v1 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e10 = word_v1;
                        let _e13 = m.params.width;
                        if (_e10 < _e13) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e18 = m.params.width;
                            let _e19 = k_v0;
                            let _e21 = word_v1;
                            let _e27 = m.params.width;
                            let _e29 = k_v0;
                            let _e31 = <u32>::load(m.nodes, 1 * (_e29 as usize));
                            let _e33 = word_v1;
                            let _e36 = <u32>::load(m.source, 1 * (_e27.wrapping_mul(_e31).wrapping_add(_e33) as usize));
                            Stored::store(_e36, m.copy, 1 * (_e18.wrapping_mul(_e19).wrapping_add(_e21) as usize));
                        }
                    }
                    let _e37 = word_v1;
                    word_v1 = _e37.wrapping_add(1u32);
                }
            }
        }
        let _e40 = k_v0;
        k_v0 = _e40.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let nodes = bound.read(0);
    let source = bound.read(1);
    let mut copy = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        nodes: &nodes,
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
