// Subtracts known forces on some nodes from the gradient.

struct Params {
    count: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<u32>;
@group(0) @binding(2) var<storage, read> forces: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> gradient: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var k = id.x; k < params.count; k += 64u * MOST_WORKGROUPS) {
        let i = nodes[k];
        gradient[i] = vec4<f32>(gradient[i].xyz - forces[k].xyz, 0.0);
    }
}
