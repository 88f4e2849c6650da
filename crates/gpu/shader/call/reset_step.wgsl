// Parts: types.
//
// Resets what the stages of a step add to.

struct Params {
    groups: u32,
    // 1: the step is made again, after a search that found no room. Trust regions have changed then, and
    // there is no backward step, which alone counts the rows that press.
    again: u32,
    // 1: it is the first step of a submission.
    first: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> group_caps: array<f32>;
@group(0) @binding(2) var<storage, read_write> group_alphas: array<f32>;
@group(0) @binding(3) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var g = id.x; g < params.groups; g += 256u * MOST_WORKGROUPS) {
        group_caps[g] = 1.0;
        group_alphas[g] = 1.0;
    }
    if id.x > 0u {
        return;
    }
    atomicStore(&control.overflow, 0u);
    atomicStore(&control.frozen, 0u);
    atomicStore(&control.free_remaining, 0u);
    atomicStore(&control.unhindered_lag, 0u);
    atomicStore(&control.lag, 0u);
    atomicStore(&control.largest_move, 0u);
    atomicStore(&control.free_move, 0u);
    atomicStore(&control.unhindered, 0u);
    atomicStore(&control.net_residual, 0u);
    atomicStore(&control.mean_residual, 0u);
    atomicStore(&control.stretch_to_limit, 0u);
    if params.again == 0u {
        atomicStore(&control.changed, 0u);
        atomicStore(&control.pressing, 0u);
    }
    if params.first != 0u {
        atomicStore(&control.halted, 0u);
        atomicStore(&control.steps, 0u);
    }
}
