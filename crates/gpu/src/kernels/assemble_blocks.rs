// Written from `shader/elements/assemble_blocks.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "assemble_blocks",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/elements/assemble_blocks.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const SLICE: u32 = 32u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub entries: u32,
    pub nodes: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::assemble_blocks::*;
use crate::wgsl::*;

#[derive(Clone, Copy)]
pub struct Entry {
    pub at: u32,
    pub first: u32,
    pub count: u32,
    pub bending: f32,
}

impl Entry {
    const ZERO: Self = Self {
        at: 0u32,
        first: 0u32,
        count: 0u32,
        bending: 0.0f32,
    };
}

impl Stored for Entry {
    const WORDS: usize = 4;

    fn load(words: &[u32], at: usize) -> Self {
        Self {
            at: <u32>::load(words, at + 0),
            first: <u32>::load(words, at + 1),
            count: <u32>::load(words, at + 2),
            bending: <f32>::load(words, at + 3),
        }
    }

    fn store(self, words: &mut [u32], at: usize) {
        self.at.store(words, at + 0);
        self.first.store(words, at + 1);
        self.count.store(words, at + 2);
        self.bending.store(words, at + 3);
    }
}

struct Memory<'a> {
    params: Params,
    entries: &'a [u32],
    sources: &'a [u32],
    blocks: &'a [u32],
    slices: &'a [u32],
    row_sums: &'a [u32],
    words: &'a mut [u32],
}

pub fn write(m: &mut Memory<'_>, at_a0: u32, columns_a1: [[f32; 3]; 3]) {
    let mut c_v0: u32 = 0u32;
    'l0: loop {
        'c0: {
            let _e4 = c_v0;
            if (_e4 < 3u32) {
            } else {
                break 'l0;
            }
            {
                let _e10 = c_v0;
                let _e17 = c_v0;
                Stored::store(((columns_a1)[_e17 as usize])[0].to_bits(), m.words, 1 * (at_a0.wrapping_add(1u32.wrapping_add(3u32.wrapping_mul(_e10)).wrapping_mul(32u32)) as usize));
                let _e24 = c_v0;
                let _e31 = c_v0;
                Stored::store(((columns_a1)[_e31 as usize])[1].to_bits(), m.words, 1 * (at_a0.wrapping_add(2u32.wrapping_add(3u32.wrapping_mul(_e24)).wrapping_mul(32u32)) as usize));
                let _e38 = c_v0;
                let _e45 = c_v0;
                Stored::store(((columns_a1)[_e45 as usize])[2].to_bits(), m.words, 1 * (at_a0.wrapping_add(3u32.wrapping_add(3u32.wrapping_mul(_e38)).wrapping_mul(32u32)) as usize));
            }
        }
        let _e49 = c_v0;
        c_v0 = _e49.wrapping_add(1u32);
    }
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut t_v0: u32;
    t_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = t_v0;
            let _e6 = m.params.entries;
            let _e9 = m.params.nodes;
            if (_e3 < _e6.wrapping_add(_e9)) {
            } else {
                break 'l0;
            }
            {
                let _e12 = t_v0;
                let _e15 = m.params.entries;
                if (_e12 >= _e15) {
                    let _e17 = t_v0;
                    let _e20 = m.params.entries;
                    let i_e21 = _e17.wrapping_sub(_e20);
                    let a_e23 = 6u32.wrapping_mul(i_e21);
                    let xx_e26 = <f32>::load(m.row_sums, 1 * (a_e23 as usize));
                    let xy_e31 = <f32>::load(m.row_sums, 1 * (a_e23.wrapping_add(1u32) as usize));
                    let xz_e36 = <f32>::load(m.row_sums, 1 * (a_e23.wrapping_add(2u32) as usize));
                    let yy_e41 = <f32>::load(m.row_sums, 1 * (a_e23.wrapping_add(3u32) as usize));
                    let yz_e46 = <f32>::load(m.row_sums, 1 * (a_e23.wrapping_add(4u32) as usize));
                    let zz_e51 = <f32>::load(m.row_sums, 1 * (a_e23.wrapping_add(5u32) as usize));
                    let _e57 = <u32>::load(m.slices, 4 * ((i_e21 / 32u32) as usize));
                    let at_e60 = _e57.wrapping_add((i_e21 % 32u32));
                    let _e61 = [xx_e26, xy_e31, xz_e36];
                    let _e62 = [xy_e31, yy_e41, yz_e46];
                    let _e63 = [xz_e36, yz_e46, zz_e51];
                    write(m, at_e60, [_e61, _e62, _e63]);
                    break 'c0;
                }
                let _e66 = t_v0;
                let entry_e68 = <Entry>::load(m.entries, 4 * (_e66 as usize));
                let _e69 = (entry_e68).bending;
                let _e72 = [_e69, 0.0f32, 0.0f32];
                let _e73 = (entry_e68).bending;
                let _e76 = [0.0f32, _e73, 0.0f32];
                let _e77 = (entry_e68).bending;
                let _e80 = [0.0f32, 0.0f32, _e77];
                let mut sum_v1: [[f32; 3]; 3];
                sum_v1 = [_e72, _e76, _e80];
                let mut k_v2: u32;
                k_v2 = (entry_e68).first;
                'l1: loop {
                    'c1: {
                        let _e85 = k_v2;
                        if (_e85 < (entry_e68).first.wrapping_add((entry_e68).count)) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e91 = k_v2;
                            let source_e93 = <u32>::load(m.sources, 1 * (_e91 as usize));
                            let b_e97 = 9u32.wrapping_mul((source_e93 / 2u32));
                            let _e100 = <f32>::load(m.blocks, 1 * (b_e97 as usize));
                            let _e105 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(1u32) as usize));
                            let _e110 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(2u32) as usize));
                            let _e111 = [_e100, _e105, _e110];
                            let _e116 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(3u32) as usize));
                            let _e121 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(4u32) as usize));
                            let _e126 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(5u32) as usize));
                            let _e127 = [_e116, _e121, _e126];
                            let _e132 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(6u32) as usize));
                            let _e137 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(7u32) as usize));
                            let _e142 = <f32>::load(m.blocks, 1 * (b_e97.wrapping_add(8u32) as usize));
                            let _e143 = [_e132, _e137, _e142];
                            let block_e144 = [_e111, _e127, _e143];
                            if ((source_e93 % 2u32) == 1u32) {
                                let _e149 = sum_v1;
                                sum_v1 = zip(_e149, transpose(block_e144), |a, b| zip(a, b, |x, y| (x + y)));
                            } else {
                                let _e152 = sum_v1;
                                sum_v1 = zip(_e152, block_e144, |a, b| zip(a, b, |x, y| (x + y)));
                            }
                        }
                    }
                    let _e154 = k_v2;
                    k_v2 = _e154.wrapping_add(1u32);
                }
                let _e158 = sum_v1;
                write(m, (entry_e68).at, _e158);
            }
        }
        let _e159 = t_v0;
        t_v0 = _e159.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let entries = bound.read(0);
    let sources = bound.read(1);
    let blocks = bound.read(2);
    let slices = bound.read(3);
    let row_sums = bound.read(4);
    let mut words = bound.write(5);
    let mut m = Memory {
        params: bound.params(),
        entries: &entries,
        sources: &sources,
        blocks: &blocks,
        slices: &slices,
        row_sums: &row_sums,
        words: &mut words,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
