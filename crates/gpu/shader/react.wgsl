// The reaction of each spring to the search direction p: its Hessian times the weighted sum of p over its nodes.

struct Params {
    springs: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> springs: array<Spring>;
@group(0) @binding(2) var<storage, read> direction: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> reactions: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var s = id.x; s < params.springs; s += 64u * MOST_WORKGROUPS) {
        let spring = springs[s];
        var sum = vec3<f32>(0.0);
        for (var k = 0u; k < 4u; k += 1u) {
            sum += spring.weights[k] * direction[spring.nodes[k]].xyz;
        }
        let reaction = spring.hessian[0] * sum.x + spring.hessian[1] * sum.y + spring.hessian[2] * sum.z;
        reactions[s] = reaction;
    }
}
