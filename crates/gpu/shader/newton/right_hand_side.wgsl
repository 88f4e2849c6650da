// Parts: linear, sum, largest, newton, free.
//
// The right-hand side of a Newton system, b = -(g + H q) at free nodes and 0 at others, with the forces of
// springs; and the largest of its numbers by workgroup.

struct Params {
    nodes: u32,
    springs: u32,
    // 1: image holds H q, of the displacements of nodes that are not free.
    imposed: u32,
    workgroups: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> gradient: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> image: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> springs: array<Spring>;
@group(0) @binding(4) var<storage, read> spring_words: array<u32>;
@group(0) @binding(5) var<storage, read> free: array<u32>;
// The fourth number is 1 at free nodes, else 0.
@group(0) @binding(6) var<storage, read_write> right_side: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> sums: array<f32>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var largest = 0.0;
    for (var i = THREADS * group.x + local.x; i < params.nodes; i += THREADS * params.workgroups) {
        var b = vec4<f32>(0.0);
        if is_free(i) {
            var sum = gradient[i].xyz;
            if params.imposed == 1u {
                sum += image[i].xyz;
            }
            if params.springs > 0u {
                let end = spring_words[i + 1u];
                for (var e = spring_words[i]; e < end; e += 2u) {
                    let hessian = springs[spring_words[e]].hessian;
                    let force = vec3<f32>(hessian[0].w, hessian[1].w, hessian[2].w);
                    sum -= bitcast<f32>(spring_words[e + 1u]) * force;
                }
            }
            b = vec4<f32>(-sum, 1.0);
        }
        right_side[i] = b;
        largest = max(largest, largest_component(b.xyz));
    }
    let all = largest_of_threads(local.x, largest);
    if local.x == 0u {
        sums[group.x] = all;
    }
}
