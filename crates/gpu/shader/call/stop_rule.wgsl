// Parts: types.
//
// Decides after a step whether the submission goes on: not if the call has ended by its rule, if the next
// step makes another number of sweeps, or if a buffer was too small, which is known after a search or within
// a step too. All dispatches that follow are then left without workgroups. It keeps what the step came to.

struct Params {
    // A distance below which vertices have arrived, those that no pair holds back, and the residuals below
    // which a call ends; the largest ratio of an edge to its limit.
    distance: f32,
    unhindered: f32,
    net_residual: f32,
    mean_residual: f32,
    stretch: f32,
    // Most steps beyond the rule.
    finishing_steps: u32,
    // Below this distance and above this ratio of an edge to its limit the next step polishes.
    polish_distance: f32,
    polish_stretch: f32,
    // 1: the steps of this submission polish.
    polishes: u32,
    // What has gone before.
    after: u32,
    // Dispatches that have arguments.
    dispatches: u32,
}

// A step; the search at the start of a call; the list of the rows of a step.
const AFTER_STEP: u32 = 0u;
const AFTER_SEARCH: u32 = 1u;
const AFTER_ROWS: u32 = 2u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> reports: array<Report>;
// Three words per dispatch, the numbers of workgroups.
@group(0) @binding(3) var<storage, read_write> arguments: array<u32>;

// A copy of Control.
struct Report {
    words: array<u32, 19>,
}

var<workgroup> shared_halted: u32;

fn remaining() -> u32 {
    return max(atomicLoad(&control.free_remaining), atomicLoad(&control.lag));
}

// Whether the state meets the rule. What is not a number does not.
fn is_met() -> bool {
    let has_arrived = bitcast<f32>(remaining()) < params.distance
        && bitcast<f32>(atomicLoad(&control.unhindered)) < params.unhindered
        && atomicLoad(&control.unhindered_lag) == 0u;
    let balances = bitcast<f32>(atomicLoad(&control.net_residual)) < params.net_residual;
    let limits_hold = bitcast<f32>(atomicLoad(&control.stretch_to_limit)) <= params.stretch;
    if !(has_arrived && balances && limits_hold) {
        return false;
    }
    let last = bitcast<f32>(atomicLoad(&control.last_mean_residual));
    let mean = bitcast<f32>(atomicLoad(&control.mean_residual));
    atomicStore(&control.last_mean_residual, bitcast<u32>(mean));
    return mean < params.mean_residual || mean > 0.5 * last;
}

// Whether the call goes on although the rule is met, to reach the target to the bit.
fn takes_finishing_step() -> bool {
    let count = atomicLoad(&control.finishing_steps);
    let takes = remaining() > 0u && count < params.finishing_steps && atomicLoad(&control.pressing) == 0u;
    if takes {
        atomicStore(&control.finishing_steps, count + 1u);
    }
    return takes;
}

fn polishes_next() -> bool {
    return bitcast<f32>(remaining()) < params.polish_distance
        && bitcast<f32>(atomicLoad(&control.stretch_to_limit)) > params.polish_stretch;
}

fn keep_report(step: u32) {
    reports[step].words[0] = atomicLoad(&control.changed);
    reports[step].words[1] = atomicLoad(&control.overflow);
    reports[step].words[2] = atomicLoad(&control.frozen);
    reports[step].words[3] = atomicLoad(&control.free_remaining);
    reports[step].words[4] = atomicLoad(&control.unhindered_lag);
    reports[step].words[5] = atomicLoad(&control.lag);
    reports[step].words[6] = atomicLoad(&control.largest_move);
    reports[step].words[7] = atomicLoad(&control.free_move);
    reports[step].words[8] = atomicLoad(&control.unhindered);
    reports[step].words[9] = atomicLoad(&control.net_residual);
    reports[step].words[10] = atomicLoad(&control.mean_residual);
    reports[step].words[11] = atomicLoad(&control.stretch_to_limit);
    reports[step].words[12] = atomicLoad(&control.pressing);
    reports[step].words[13] = atomicLoad(&control.candidates);
    reports[step].words[14] = atomicLoad(&control.rows);
    reports[step].words[15] = atomicLoad(&control.halted);
    reports[step].words[16] = atomicLoad(&control.steps);
    reports[step].words[17] = atomicLoad(&control.last_mean_residual);
    reports[step].words[18] = atomicLoad(&control.finishing_steps);
}

fn stops() -> u32 {
    if params.after != AFTER_STEP {
        return (1u + params.after) * atomicLoad(&control.overflow);
    }
    if atomicLoad(&control.overflow) != 0u {
        return 1u;
    }
    let step = atomicLoad(&control.steps);
    keep_report(step);
    atomicStore(&control.steps, step + 1u);
    var ends = is_met();
    if ends {
        ends = !takes_finishing_step();
    }
    return u32(ends || polishes_next() != (params.polishes != 0u));
}

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_halted = atomicLoad(&control.halted);
        if shared_halted == 0u {
            shared_halted = stops();
            atomicStore(&control.halted, shared_halted);
        }
    }
    if workgroupUniformLoad(&shared_halted) == 0u {
        return;
    }
    for (var d = local.x; d < params.dispatches; d += 256u) {
        arguments[3u * d] = 0u;
    }
}
