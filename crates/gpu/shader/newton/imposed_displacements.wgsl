// The displacements q of nodes that are not free, in meters.

struct Params {
    nodes: u32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> imposed: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read_write> direction: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        direction[i] = vec4<f32>(vec3<f32>(imposed[i].xyz) * params.quantum, 0.0);
    }
}
