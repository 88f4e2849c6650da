// Parts: segments.
//
// r . z and r . r by block, of the residual r and the preconditioned one z. A window of nodes per workgroup.

struct Params {
    nodes: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<u32>;
// Of each node x, then of each node r.
@group(0) @binding(2) var<storage, read> solution: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> direction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> totals: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var first = WINDOW * group.x; first < params.nodes; first += WINDOW * MOST_WORKGROUPS) {
        let i = first + local.x;
        var segment = NO_SEGMENT;
        var value = vec4<f32>(0.0);
        if i < params.nodes {
            segment = blocks[i];
            let r = solution[params.nodes + i].xyz;
            value = vec4<f32>(dot(r, direction[i].xyz), dot(r, r), 0.0, 0.0);
        }
        let sum = sum_of_segment(local.x, segment, value);
        if is_first_of_segment(local.x, segment) {
            totals[segment] = sum;
        }
    }
}
