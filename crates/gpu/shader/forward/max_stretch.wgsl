// Parts: types, most.
//
// Largest ratio of an edge's length to its limit.

struct Params {
    edges: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> limits: array<EdgeLimit>;
@group(0) @binding(3) var<storage, read_write> control: Control;

const WORDS: u32 = 1u;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var largest = 0u;
    for (var e = id.x; e < params.edges; e += 256u * MOST_WORKGROUPS) {
        let edge = vec3<f32>(positions[limits[e].b].xyz - positions[limits[e].a].xyz);
        largest = max(largest, bitcast<u32>(sqrt(dot(edge, edge)) / limits[e].limit));
    }
    find_most(local.x, array<u32, WORDS>(largest));
    if local.x == 0u {
        atomicMax(&control.stretch_to_limit, most[0]);
    }
}
