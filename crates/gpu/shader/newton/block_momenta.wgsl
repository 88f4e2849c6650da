// Parts: segments.
//
// R (d + p) by block: the forces of inertia and drag after the step p, with the displacement d since the
// start of the time step. A window of nodes per workgroup.

struct Params {
    nodes: u32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<u32>;
@group(0) @binding(2) var<storage, read> iterate: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> start: array<vec4<i32>>;
// xx, xy, xz, yy, yz, zz of each node.
@group(0) @binding(4) var<storage, read> row_sums: array<f32>;
@group(0) @binding(5) var<storage, read> step: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> totals: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var first = WINDOW * group.x; first < params.nodes; first += WINDOW * MOST_WORKGROUPS) {
        let i = first + local.x;
        var segment = NO_SEGMENT;
        var value = vec4<f32>(0.0);
        if i < params.nodes {
            segment = blocks[i];
            let d = vec3<f32>(iterate[i].xyz - start[i].xyz) * params.quantum + step[i].xyz;
            let at = 6u * i;
            value = vec4<f32>(
                row_sums[at] * d.x + row_sums[at + 1u] * d.y + row_sums[at + 2u] * d.z,
                row_sums[at + 1u] * d.x + row_sums[at + 3u] * d.y + row_sums[at + 4u] * d.z,
                row_sums[at + 2u] * d.x + row_sums[at + 4u] * d.y + row_sums[at + 5u] * d.z,
                0.0,
            );
        }
        let sum = sum_of_segment(local.x, segment, value);
        if is_first_of_segment(local.x, segment) {
            totals[segment] = sum;
        }
    }
}
