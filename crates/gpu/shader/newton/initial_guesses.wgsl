// Parts: free.
//
// Guesses of a Newton step: the ways of free nodes from the iterate to the last target and to where inertia
// leads.

struct Params {
    nodes: u32,
    // 1: there is no last target, and the way of inertia is the first one.
    count: u32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> iterate: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> inertial: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read> last: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read> free: array<u32>;
@group(0) @binding(5) var<storage, read_write> direction: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> second: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        var by_inertia = vec3<f32>(0.0);
        var back = vec3<f32>(0.0);
        if is_free(i) {
            let x = iterate[i].xyz;
            by_inertia = vec3<f32>(inertial[i].xyz - x) * params.quantum;
            if params.count == 2u {
                back = vec3<f32>(last[i].xyz - x) * params.quantum;
            }
        }
        if params.count == 2u {
            direction[i] = vec4<f32>(back, 0.0);
            second[i] = vec4<f32>(by_inertia, 0.0);
        } else {
            direction[i] = vec4<f32>(by_inertia, 0.0);
        }
    }
}
