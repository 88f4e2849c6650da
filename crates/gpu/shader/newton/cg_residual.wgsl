// Parts: newton.
//
// What conjugate gradients start from: the residual b - H p times the factor, or b times the factor. Nothing
// is done between the iterations of a round.

struct Params {
    nodes: u32,
    // 1: image holds H p.
    subtract: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> right_side: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> image: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> solve: Solve;
@group(0) @binding(4) var<storage, read_write> direction: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if solve.ended == 0u {
        return;
    }
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        let b = right_side[i];
        var r = vec3<f32>(0.0);
        if b.w == 1.0 {
            r = b.xyz;
            if params.subtract == 1u {
                r -= image[i].xyz;
            }
            r *= solve.factor;
        }
        direction[i] = vec4<f32>(r, 0.0);
    }
}
