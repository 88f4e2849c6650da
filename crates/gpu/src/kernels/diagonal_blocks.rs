// Written from `shader/elements/diagonal_blocks.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "diagonal_blocks",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/elements/diagonal_blocks.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const SLICE: u32 = 32u32;
pub const BLOCK_WORDS: u32 = 10u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::diagonal_blocks::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    slices: &'a [u32],
    words: &'a [u32],
    diagonal: &'a mut [u32],
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
                let slice_e13 = <[u32; 4]>::load(m.slices, 4 * ((_e9 / 32u32) as usize));
                let _e15 = i_v0;
                let mut at_v1: u32;
                at_v1 = (slice_e13)[0].wrapping_add((_e15 % 32u32));
                let mut sum_v2: [f32; 9];
                sum_v2 = [0.0f32; 9];
                let mut k_v3: u32;
                k_v3 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e24 = k_v3;
                        if (_e24 < (slice_e13)[1]) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e27 = k_v3;
                            let sign_e32 = (if (_e27 == 0u32) { 1.0f32 } else { (-1.0f32) });
                            let mut c_v4: u32;
                            c_v4 = 0u32;
                            'l2: loop {
                                'c2: {
                                    let _e35 = c_v4;
                                    if (_e35 < 9u32) {
                                    } else {
                                        break 'l2;
                                    }
                                    {
                                        let _e38 = c_v4;
                                        let _e40 = sum_v2[_e38 as usize];
                                        let _e42 = at_v1;
                                        let _e44 = c_v4;
                                        let _e50 = <u32>::load(m.words, 1 * (_e42.wrapping_add(1u32.wrapping_add(_e44).wrapping_mul(32u32)) as usize));
                                        sum_v2[_e38 as usize] = (_e40 + (sign_e32 * f32::from_bits(_e50 as u32)));
                                    }
                                }
                                let _e54 = c_v4;
                                c_v4 = _e54.wrapping_add(1u32);
                            }
                            let _e57 = at_v1;
                            at_v1 = _e57.wrapping_add(320u32);
                        }
                    }
                    let _e60 = k_v3;
                    k_v3 = _e60.wrapping_add(1u32);
                }
                let mut scalars_v5: f32;
                scalars_v5 = 0.0f32;
                let mut k_v6: u32;
                k_v6 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e67 = k_v6;
                        if (_e67 < (slice_e13)[2]) {
                        } else {
                            break 'l3;
                        }
                        {
                            let _e70 = scalars_v5;
                            let _e72 = at_v1;
                            let _e76 = <u32>::load(m.words, 1 * (_e72.wrapping_add(32u32) as usize));
                            scalars_v5 = (_e70 + f32::from_bits(_e76 as u32));
                            let _e79 = at_v1;
                            at_v1 = _e79.wrapping_add(64u32);
                        }
                    }
                    let _e82 = k_v6;
                    k_v6 = _e82.wrapping_add(1u32);
                }
                let _e87 = i_v0;
                let _e91 = sum_v2[0];
                let _e92 = scalars_v5;
                Stored::store((_e91 - _e92), m.diagonal, 1 * (6u32.wrapping_mul(_e87) as usize));
                let _e96 = i_v0;
                let _e102 = sum_v2[1];
                let _e104 = sum_v2[3];
                Stored::store((0.5f32 * (_e102 + _e104)), m.diagonal, 1 * (6u32.wrapping_mul(_e96).wrapping_add(1u32) as usize));
                let _e110 = i_v0;
                let _e116 = sum_v2[2];
                let _e118 = sum_v2[6];
                Stored::store((0.5f32 * (_e116 + _e118)), m.diagonal, 1 * (6u32.wrapping_mul(_e110).wrapping_add(2u32) as usize));
                let _e124 = i_v0;
                let _e130 = sum_v2[4];
                let _e131 = scalars_v5;
                Stored::store((_e130 - _e131), m.diagonal, 1 * (6u32.wrapping_mul(_e124).wrapping_add(3u32) as usize));
                let _e135 = i_v0;
                let _e141 = sum_v2[5];
                let _e143 = sum_v2[7];
                Stored::store((0.5f32 * (_e141 + _e143)), m.diagonal, 1 * (6u32.wrapping_mul(_e135).wrapping_add(4u32) as usize));
                let _e149 = i_v0;
                let _e155 = sum_v2[8];
                let _e156 = scalars_v5;
                Stored::store((_e155 - _e156), m.diagonal, 1 * (6u32.wrapping_mul(_e149).wrapping_add(5u32) as usize));
            }
        }
        let _e158 = i_v0;
        i_v0 = _e158.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let slices = bound.read(0);
    let words = bound.read(1);
    let mut diagonal = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        slices: &slices,
        words: &words,
        diagonal: &mut diagonal,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
