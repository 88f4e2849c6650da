// Parts: linear, newton.
//
// Ends a round of conjugate gradients, if it is to end: its solution is added to the Newton step.

struct Params {
    nodes: u32,
    // 1: no more iterations follow.
    last: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> solution: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> progress: Progress;
@group(0) @binding(3) var<storage, read_write> ended: Progress;
@group(0) @binding(4) var<storage, read_write> solve: Solve;
@group(0) @binding(5) var<storage, read_write> step: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let ends = params.last == 1u || atomicLoad(&progress.moving) == 0u;
    if id.x == 0u {
        atomicStore(&ended.moving, select(0u, 1u, ends));
        solve.ended = select(0u, 1u, ends);
    }
    if !ends {
        return;
    }
    let inverse = solve.inverse;
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        step[i] = vec4<f32>(step[i].xyz + inverse * solution[i].xyz, 0.0);
    }
}
