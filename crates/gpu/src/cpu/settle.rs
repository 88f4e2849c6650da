//! Twin of `shader/settle.wgsl`.

use super::sum::sum_of_parts;
use crate::bound::Bound;
use crate::linear::Progress;
use crate::newton::Solve;
use bytemuck::{Pod, Zeroable};

const MARGIN: f32 = 0.9025;
const MAX_REDUCTION: f32 = 1e-10;

#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Params {
    pub mode: u32,
    pub first: u32,
    pub count: u32,
    pub tolerance: f32,
    pub own_tolerance: f32,
    pub min_scale: f32,
}

/// The modes.
pub const FACTOR: u32 = 0;
pub const SCALE: u32 = 1;
pub const START: u32 = 2;
pub const ROUND: u32 = 3;

pub fn bound(buffers: Bound<'_>) {
    settle(
        buffers.params(),
        &buffers.read(0),
        &mut buffers.write::<Solve>(1)[0],
        &mut buffers.write::<Progress>(2)[0],
        &mut buffers.write::<Progress>(3)[0],
    );
}

pub fn settle(
    params: Params,
    sums: &[f32],
    solve: &mut Solve,
    progress: &mut Progress,
    ended: &mut Progress,
) {
    let parts = &sums[params.first as usize..][..params.count as usize];
    if params.mode == FACTOR {
        let bits = parts.iter().copied().fold(0.0, f32::max).to_bits() & 0x7f80_0000;
        let is_usual = bits > 0 && bits < 0x7f00_0000;
        solve.factor = f32::from_bits(if is_usual { 0x7f00_0000 - bits } else { 0x3f80_0000 });
        solve.inverse = f32::from_bits(if is_usual { bits } else { 0x3f80_0000 });
        return;
    }
    let norm = sum_of_parts(parts);
    let goal = |goal: f32| (MARGIN * goal).max(MAX_REDUCTION * norm);
    match params.mode {
        SCALE => solve.scale = norm,
        START => {
            let mut relative = solve.scale;
            if params.min_scale > 0.0 {
                relative = relative.max(params.min_scale * solve.factor * solve.factor);
            }
            solve.goal = (params.tolerance * relative).max(params.own_tolerance * solve.scale);
            solve.norm = norm;
            solve.reached = norm;
            solve.iterations = 0;
            solve.ended = 0;
            *progress = Progress { moving: 1, iterations: 0, goal: goal(solve.goal) };
            ended.moving = 0;
        }
        _ => {
            solve.iterations = progress.iterations;
            solve.reached = norm;
            if solve.ended == 1 {
                solve.before = solve.norm;
                solve.norm = norm;
                progress.goal = goal(solve.goal);
                progress.moving = 1;
            }
        }
    }
}
