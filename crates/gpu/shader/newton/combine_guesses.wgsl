// Parts: sum, newton.
//
// The combination of guesses with the least energy is where a linear solve starts: the minimum along the
// first one, then along the part of the second one that is conjugate to the first. Its residual takes the
// place of the first guess.

struct Params {
    nodes: u32,
    count: u32,
    // Of the sums by workgroup.
    workgroups: u32,
    first: u32,
}

// A second guess whose conjugate part has less than this share of its curvature counts as parallel to the
// first: what is left is rounding.
const MIN_CONJUGATE: f32 = 1e-5;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> image: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> second: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> second_image: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> right_side: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> sums: array<f32>;
@group(0) @binding(6) var<storage, read> solve: Solve;
@group(0) @binding(7) var<storage, read_write> direction: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> step: array<vec4<f32>>;

fn product(thread: u32, column: u32) -> f32 {
    var sum = 0.0;
    for (var k = thread; k < params.workgroups; k += THREADS) {
        sum += sums[params.first + 8u * k + column];
    }
    return sum_of_threads(thread, sum);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let curvature = product(local.x, 0u);
    let slope = product(local.x, 1u);
    let mixed = product(local.x, 2u);
    let other_curvature = product(local.x, 3u);
    let other_slope = product(local.x, 4u);
    var along = 0.0;
    var along_other = 0.0;
    var share = 0.0;
    if is_positive(solve.scale) {
        if is_positive(curvature) {
            along = slope / curvature;
            share = -mixed / curvature;
        }
        if params.count == 2u {
            let conjugate = other_curvature + share * mixed;
            if is_positive(conjugate) && conjugate > MIN_CONJUGATE * other_curvature {
                along_other = (other_slope + share * slope) / conjugate;
                along += along_other * share;
            }
        }
    }
    for (var i = id.x; i < params.nodes; i += 256u * MOST_WORKGROUPS) {
        let b = right_side[i];
        var p = along * direction[i].xyz;
        var q = along * image[i].xyz;
        if params.count == 2u {
            p += along_other * second[i].xyz;
            q += along_other * second_image[i].xyz;
        }
        step[i] = vec4<f32>(p, 0.0);
        var r = vec3<f32>(0.0);
        if b.w == 1.0 {
            r = solve.factor * (b.xyz - q);
        }
        direction[i] = vec4<f32>(r, 0.0);
    }
}
