// Written from `shader/call/stop_rule.wgsl` by `cargo xtask twins`: change that file, not this one.

use crate::stages::Access::{Read, Write};
use crate::stages::Stage;
use bytemuck::{Pod, Zeroable};

pub static STAGE: Stage = Stage {
    name: "stop_rule",
    parts: &[
        include_str!("../../shader/shared/dispatch.wgsl"),
        include_str!("../../shader/shared/types.wgsl"),
        include_str!("../../shader/call/stop_rule.wgsl"),
    ],
    workgroup: 256,
    bindings: &[Write, Write, Write],
    #[cfg(feature = "twins")]
    twin: twin::run,
};

pub const MOST_WORKGROUPS: u32 = 65535u32;
pub const NONE: u32 = 4294967295u32;
pub const OBSTACLE: u32 = 1u32;
pub const PRESCRIBED: u32 = 2u32;
pub const SELF_COLLIDES: u32 = 4u32;
pub const KNOWN: u32 = 8u32;
pub const ELEMENT_BITS: u32 = 29u32;
pub const ELEMENT_MASK: u32 = 536870911u32;
pub const VERTEX_VERTEX: u32 = 0u32;
pub const VERTEX_EDGE: u32 = 1u32;
pub const VERTEX_TRIANGLE: u32 = 2u32;
pub const EDGE_EDGE: u32 = 3u32;
pub const VERTEX_HALF_SPACE: u32 = 4u32;
pub const COLORS: u32 = 128u32;
pub const FIXED: u32 = 65535u32;
pub const AFTER_STEP: u32 = 0u32;
pub const AFTER_SEARCH: u32 = 1u32;
pub const AFTER_ROWS: u32 = 2u32;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub distance: f32,
    pub unhindered: f32,
    pub net_residual: f32,
    pub mean_residual: f32,
    pub stretch: f32,
    pub finishing_steps: u32,
    pub polish_distance: f32,
    pub polish_stretch: f32,
    pub polishes: u32,
    pub after: u32,
    pub dispatches: u32,
}

#[cfg(feature = "twins")]
pub mod twin {
use crate::kernels::stop_rule::*;
use crate::wgsl::*;

struct Memory<'a> {
    params: Params,
    control: &'a mut [u32],
    reports: &'a mut [u32],
    arguments: &'a mut [u32],
    shared_halted: u32,
}

pub fn remaining(m: &mut Memory<'_>) -> u32 {
    let _e2 = <u32>::load(m.control, 3);
    let _e5 = <u32>::load(m.control, 5);
    return _e2.max(_e5);
}

pub fn is_met(m: &mut Memory<'_>) -> bool {
    let _e0 = remaining(m);
    let _e4 = m.params.distance;
    let mut local_v0: bool;
    if (f32::from_bits(_e0 as u32) < _e4) {
        let _e10 = <u32>::load(m.control, 8);
        let _e14 = m.params.unhindered;
        local_v0 = (f32::from_bits(_e10 as u32) < _e14);
    } else {
        local_v0 = false;
    }
    let _e17 = local_v0;
    let mut local_v1: bool;
    if _e17 {
        let _e22 = <u32>::load(m.control, 4);
        local_v1 = (_e22 == 0u32);
    } else {
        local_v1 = false;
    }
    let has_arrived_e26 = local_v1;
    let _e29 = <u32>::load(m.control, 9);
    let _e33 = m.params.net_residual;
    let balances_e34 = (f32::from_bits(_e29 as u32) < _e33);
    let _e37 = <u32>::load(m.control, 11);
    let _e41 = m.params.stretch;
    let limits_hold_e42 = (f32::from_bits(_e37 as u32) <= _e41);
    let mut local_v2: bool;
    if has_arrived_e26 {
        local_v2 = balances_e34;
    } else {
        local_v2 = false;
    }
    let _e46 = local_v2;
    let mut local_v3: bool;
    if _e46 {
        local_v3 = limits_hold_e42;
    } else {
        local_v3 = false;
    }
    let _e50 = local_v3;
    if (!_e50) {
        return false;
    }
    let _e55 = <u32>::load(m.control, 17);
    let last_e56 = f32::from_bits(_e55 as u32);
    let _e59 = <u32>::load(m.control, 10);
    let mean_e60 = f32::from_bits(_e59 as u32);
    Stored::store(mean_e60.to_bits(), m.control, 17);
    let _e66 = m.params.mean_residual;
    let mut local_v4: bool;
    if (!(mean_e60 < _e66)) {
        local_v4 = (mean_e60 > (0.5f32 * last_e56));
    } else {
        local_v4 = true;
    }
    let _e75 = local_v4;
    return _e75;
}

pub fn takes_finishing_step(m: &mut Memory<'_>) -> bool {
    let count_e2 = <u32>::load(m.control, 18);
    let _e3 = remaining(m);
    let mut local_v0: bool;
    if (_e3 > 0u32) {
        let _e10 = m.params.finishing_steps;
        local_v0 = (count_e2 < _e10);
    } else {
        local_v0 = false;
    }
    let _e13 = local_v0;
    let mut local_v1: bool;
    if _e13 {
        let _e18 = <u32>::load(m.control, 12);
        local_v1 = (_e18 == 0u32);
    } else {
        local_v1 = false;
    }
    let takes_e22 = local_v1;
    if takes_e22 {
        Stored::store(count_e2.wrapping_add(1u32), m.control, 18);
    }
    return takes_e22;
}

pub fn polishes_next(m: &mut Memory<'_>) -> bool {
    let _e0 = remaining(m);
    let _e4 = m.params.polish_distance;
    let mut local_v0: bool;
    if (f32::from_bits(_e0 as u32) < _e4) {
        let _e10 = <u32>::load(m.control, 11);
        let _e14 = m.params.polish_stretch;
        local_v0 = (f32::from_bits(_e10 as u32) > _e14);
    } else {
        local_v0 = false;
    }
    let _e17 = local_v0;
    return _e17;
}

pub fn keep_report(m: &mut Memory<'_>, step_a0: u32) {
    let _e7 = <u32>::load(m.control, 0);
    Stored::store(_e7, m.reports, 19 * (step_a0 as usize));
    let _e14 = <u32>::load(m.control, 1);
    Stored::store(_e14, m.reports, 19 * (step_a0 as usize) + 1);
    let _e21 = <u32>::load(m.control, 2);
    Stored::store(_e21, m.reports, 19 * (step_a0 as usize) + 2);
    let _e28 = <u32>::load(m.control, 3);
    Stored::store(_e28, m.reports, 19 * (step_a0 as usize) + 3);
    let _e35 = <u32>::load(m.control, 4);
    Stored::store(_e35, m.reports, 19 * (step_a0 as usize) + 4);
    let _e42 = <u32>::load(m.control, 5);
    Stored::store(_e42, m.reports, 19 * (step_a0 as usize) + 5);
    let _e49 = <u32>::load(m.control, 6);
    Stored::store(_e49, m.reports, 19 * (step_a0 as usize) + 6);
    let _e56 = <u32>::load(m.control, 7);
    Stored::store(_e56, m.reports, 19 * (step_a0 as usize) + 7);
    let _e63 = <u32>::load(m.control, 8);
    Stored::store(_e63, m.reports, 19 * (step_a0 as usize) + 8);
    let _e70 = <u32>::load(m.control, 9);
    Stored::store(_e70, m.reports, 19 * (step_a0 as usize) + 9);
    let _e77 = <u32>::load(m.control, 10);
    Stored::store(_e77, m.reports, 19 * (step_a0 as usize) + 10);
    let _e84 = <u32>::load(m.control, 11);
    Stored::store(_e84, m.reports, 19 * (step_a0 as usize) + 11);
    let _e91 = <u32>::load(m.control, 12);
    Stored::store(_e91, m.reports, 19 * (step_a0 as usize) + 12);
    let _e98 = <u32>::load(m.control, 13);
    Stored::store(_e98, m.reports, 19 * (step_a0 as usize) + 13);
    let _e105 = <u32>::load(m.control, 14);
    Stored::store(_e105, m.reports, 19 * (step_a0 as usize) + 14);
    let _e112 = <u32>::load(m.control, 15);
    Stored::store(_e112, m.reports, 19 * (step_a0 as usize) + 15);
    let _e119 = <u32>::load(m.control, 16);
    Stored::store(_e119, m.reports, 19 * (step_a0 as usize) + 16);
    let _e126 = <u32>::load(m.control, 17);
    Stored::store(_e126, m.reports, 19 * (step_a0 as usize) + 17);
    let _e133 = <u32>::load(m.control, 18);
    Stored::store(_e133, m.reports, 19 * (step_a0 as usize) + 18);
}

pub fn stops(m: &mut Memory<'_>) -> u32 {
    let _e2 = m.params.after;
    if (_e2 != 0u32) {
        let _e8 = m.params.after;
        let _e12 = <u32>::load(m.control, 1);
        return 1u32.wrapping_add(_e8).wrapping_mul(_e12);
    }
    let _e16 = <u32>::load(m.control, 1);
    if (_e16 != 0u32) {
        return 1u32;
    }
    let step_e22 = <u32>::load(m.control, 16);
    keep_report(m, step_e22);
    Stored::store(step_e22.wrapping_add(1u32), m.control, 16);
    let _e27 = is_met(m);
    let mut ends_v0: bool;
    ends_v0 = _e27;
    let _e29 = ends_v0;
    if _e29 {
        let _e30 = takes_finishing_step(m);
        ends_v0 = (!_e30);
    }
    let _e32 = ends_v0;
    let mut local_v1: bool;
    if (!_e32) {
        let _e36 = polishes_next(m);
        let _e39 = m.params.polishes;
        local_v1 = (_e36 != (_e39 != 0u32));
    } else {
        local_v1 = true;
    }
    let _e44 = local_v1;
    return u32::from(_e44);
}

pub fn main(m: &mut Memory<'_>, group: u32) {
    for t in 0..256 {
        if (([t as u32, 0, 0])[0] == 0u32) {
            let _e7 = <u32>::load(m.control, 15);
            m.shared_halted = _e7;
            let _e9 = m.shared_halted;
            if (_e9 == 0u32) {
                let _e13 = stops(m);
                m.shared_halted = _e13;
                let _e17 = m.shared_halted;
                Stored::store(_e17, m.control, 15);
            }
        }
    }
    let _e19 = { let t = 0; m.shared_halted };
    'r0: for t in 0..256 {
        if (_e19 == 0u32) {
            continue 'r0;
        }
        let mut d_v0: u32;
        d_v0 = ([t as u32, 0, 0])[0];
        'l1: loop {
            'c1: {
                let _e24 = d_v0;
                let _e27 = m.params.dispatches;
                if (_e24 < _e27) {
                } else {
                    break 'l1;
                }
                {
                    let _e31 = d_v0;
                    Stored::store(0u32, m.arguments, 1 * (3u32.wrapping_mul(_e31) as usize));
                }
            }
            let _e35 = d_v0;
            d_v0 = _e35.wrapping_add(256u32);
        }
    }
}

pub fn run(bound: Bound<'_>) {
    let mut control = bound.write(0);
    let mut reports = bound.write(1);
    let mut arguments = bound.write(2);
    let mut m = Memory {
        params: bound.params(),
        control: &mut control,
        reports: &mut reports,
        arguments: &mut arguments,
        shared_halted: 0u32,
    };
    for group in 0..bound.workgroups() {
        m.shared_halted = 0u32;
        main(&mut m, group as u32);
    }
}
}
