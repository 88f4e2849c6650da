//! Twin of `shader/decide.wgsl`.

use crate::bound::Bound;
use crate::layout::Control;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
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

/// Values of [`Params::after`].
pub const AFTER_STEP: u32 = 0;
pub const AFTER_SEARCH: u32 = 1;
pub const AFTER_ROWS: u32 = 2;

pub fn bound(buffers: Bound<'_>) {
    decide(
        buffers.params(),
        &mut buffers.write::<Control>(0)[0],
        &mut buffers.write(1),
        &mut buffers.write(2),
    );
}

pub fn decide(params: Params, control: &mut Control, reports: &mut [Control], arguments: &mut [u32]) {
    if control.halted == 0 {
        control.halted = if params.after != AFTER_STEP {
            (1 + params.after) * control.overflow
        } else {
            u32::from(halts(&params, control, reports))
        };
    }
    if control.halted != 0 {
        arguments.iter_mut().step_by(3).take(params.dispatches as usize).for_each(|count| *count = 0);
    }
}

fn halts(params: &Params, control: &mut Control, reports: &mut [Control]) -> bool {
    if control.overflow != 0 {
        return true;
    }
    reports[control.steps as usize] = *control;
    control.steps += 1;
    let ends = is_met(params, control) && !takes_finishing_step(params, control);
    ends || polishes_next(params, control) != (params.polishes != 0)
}

fn is_met(params: &Params, control: &mut Control) -> bool {
    let number = f32::from_bits;
    let has_arrived = number(control.remaining()) < params.distance
        && number(control.unhindered) < params.unhindered
        && control.unhindered_lag == 0;
    let balances = number(control.net_residual) < params.net_residual;
    let limits_hold = number(control.stretch_to_limit) <= params.stretch;
    if !(has_arrived && balances && limits_hold) {
        return false;
    }
    let last = number(control.last_mean_residual);
    let mean = number(control.mean_residual);
    control.last_mean_residual = control.mean_residual;
    mean < params.mean_residual || mean > 0.5 * last
}

fn takes_finishing_step(params: &Params, control: &mut Control) -> bool {
    let takes =
        control.remaining() > 0 && control.finishing_steps < params.finishing_steps && control.pressing == 0;
    control.finishing_steps += u32::from(takes);
    takes
}

fn polishes_next(params: &Params, control: &Control) -> bool {
    let number = f32::from_bits;
    number(control.remaining()) < params.polish_distance
        && number(control.stretch_to_limit) > params.polish_stretch
}
