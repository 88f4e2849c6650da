// Written from `shader/preconditioner/factor_diagonal.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "factor_diagonal",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/linear.wgsl"),
        include_str!("../../shader/preconditioner/factor_diagonal.wgsl"),
    ],
    workgroup: 64,
    bindings: &[Read, Read, Read, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const DOMAIN_WORDS: u32 = 2304u32;
pub const MIN_PIVOT: f32 = 2e-7f32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub slots: u32,
    pub springs: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::factor_diagonal::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    diagonal: &'a [u32],
    springs: &'a [u32],
    spring_words: &'a [u32],
    slots: &'a mut [u32],
}

pub fn main(m: &mut Memory<'_>, group: u32, t: usize) {
    let mut t_v0: u32;
    t_v0 = ([64 * group + t as u32, 0, 0])[0];
    'l0: loop {
        'c0: {
            let _e3 = t_v0;
            let _e6 = m.params.slots;
            if (_e3 < _e6) {
            } else {
                break 'l0;
            }
            {
                let _e9 = t_v0;
                let i_e12 = <u32>::load(m.slots, 12 * (_e9 as usize));
                if (i_e12 == 4294967295u32) {
                    break 'c0;
                }
                let mut m_v1: [f32; 6];
                m_v1 = [0.0f32; 6];
                let mut k_v2: u32;
                k_v2 = 0u32;
                'l1: loop {
                    'c1: {
                        let _e19 = k_v2;
                        if (_e19 < 6u32) {
                        } else {
                            break 'l1;
                        }
                        {
                            let _e22 = k_v2;
                            let _e27 = k_v2;
                            let _e30 = <f32>::load(m.diagonal, 1 * (6u32.wrapping_mul(i_e12).wrapping_add(_e27) as usize));
                            m_v1[_e22 as usize] = _e30;
                        }
                    }
                    let _e31 = k_v2;
                    k_v2 = _e31.wrapping_add(1u32);
                }
                let _e36 = m.params.springs;
                if (_e36 > 0u32) {
                    let end_e43 = <u32>::load(m.spring_words, 1 * (i_e12.wrapping_add(1u32) as usize));
                    let _e46 = <u32>::load(m.spring_words, 1 * (i_e12 as usize));
                    let mut e_v3: u32;
                    e_v3 = _e46;
                    'l2: loop {
                        'c2: {
                            let _e48 = e_v3;
                            if (_e48 < end_e43) {
                            } else {
                                break 'l2;
                            }
                            {
                                let _e51 = e_v3;
                                let _e55 = <u32>::load(m.spring_words, 1 * (_e51.wrapping_add(1u32) as usize));
                                let weight_e56 = f32::from_bits(_e55 as u32);
                                let _e59 = e_v3;
                                let _e61 = <u32>::load(m.spring_words, 1 * (_e59 as usize));
                                let hessian_e64 = <[[f32; 4]; 3]>::load(m.springs, 20 * (_e61 as usize) + 8);
                                let squared_e65 = (weight_e56 * weight_e56);
                                let _e67 = m_v1[0];
                                m_v1[0] = (_e67 + (squared_e65 * ((hessian_e64)[0])[0]));
                                let _e73 = m_v1[1];
                                m_v1[1] = (_e73 + (squared_e65 * ((hessian_e64)[0])[1]));
                                let _e79 = m_v1[2];
                                m_v1[2] = (_e79 + (squared_e65 * ((hessian_e64)[0])[2]));
                                let _e85 = m_v1[3];
                                m_v1[3] = (_e85 + (squared_e65 * ((hessian_e64)[1])[1]));
                                let _e91 = m_v1[4];
                                m_v1[4] = (_e91 + (squared_e65 * ((hessian_e64)[1])[2]));
                                let _e97 = m_v1[5];
                                m_v1[5] = (_e97 + (squared_e65 * ((hessian_e64)[2])[2]));
                            }
                        }
                        let _e102 = e_v3;
                        e_v3 = _e102.wrapping_add(2u32);
                    }
                }
                let _e106 = m_v1[0];
                let _e108 = m_v1[3];
                let _e111 = m_v1[5];
                let trace_e112 = ((_e106 + _e108) + _e111);
                let unit_e114 = (1.0f32 / trace_e112);
                let mut k_v4: u32;
                k_v4 = 0u32;
                'l3: loop {
                    'c3: {
                        let _e117 = k_v4;
                        if (_e117 < 6u32) {
                        } else {
                            break 'l3;
                        }
                        {
                            let _e120 = k_v4;
                            let _e122 = m_v1[_e120 as usize];
                            m_v1[_e120 as usize] = (_e122 * unit_e114);
                        }
                    }
                    let _e124 = k_v4;
                    k_v4 = _e124.wrapping_add(1u32);
                }
                let _e128 = m_v1[0];
                let first_e130 = _e128.max(2e-7f32);
                let _e132 = m_v1[1];
                let xy_e133 = (_e132 / first_e130);
                let _e135 = m_v1[2];
                let xz_e136 = (_e135 / first_e130);
                let _e138 = m_v1[3];
                let _e140 = m_v1[1];
                let second_e144 = (_e138 - (xy_e133 * _e140)).max(2e-7f32);
                let _e146 = m_v1[4];
                let _e148 = m_v1[2];
                let rest_e150 = (_e146 - (xy_e133 * _e148));
                let yz_e151 = (rest_e150 / second_e144);
                let _e153 = m_v1[5];
                let _e155 = m_v1[2];
                let third_e161 = ((_e153 - (xz_e136 * _e155)) - (yz_e151 * rest_e150)).max(2e-7f32);
                let _e163 = t_v0;
                let _e166 = (unit_e114 / first_e130);
                let _e167 = (unit_e114 / second_e144);
                let _e168 = (unit_e114 / third_e161);
                Stored::store([xy_e133, xz_e136, yz_e151, _e166, _e167, _e168], m.slots, 12 * (_e163 as usize) + 1);
            }
        }
        let _e170 = t_v0;
        t_v0 = _e170.wrapping_add(4194240u32);
    }
}

pub fn run(bound: Bound<'_>) {
    let diagonal = bound.read(0);
    let springs = bound.read(1);
    let spring_words = bound.read(2);
    let mut slots = bound.write(3);
    let mut m = Memory {
        params: bound.params(),
        diagonal: &diagonal,
        springs: &springs,
        spring_words: &spring_words,
        slots: &mut slots,
    };
    for group in 0..bound.workgroups() {
        for t in 0..64 {
            main(&mut m, group as u32, t);
        }
    }
}
}
