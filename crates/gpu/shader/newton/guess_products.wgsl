// Parts: sum.
//
// Products of guesses g with their images q = H g and with the right-hand side b, by workgroup: g1 . q1, g1 .
// b, g2 . q1, g2 . q2, g2 . b.

struct Params {
    nodes: u32,
    count: u32,
    workgroups: u32,
    // Where the sums go, eight places per workgroup.
    first: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> direction: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> image: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> second: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> second_image: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> right_side: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> sums: array<f32>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var products: array<f32, 5>;
    for (var i = THREADS * group.x + local.x; i < params.nodes; i += THREADS * params.workgroups) {
        let b = right_side[i].xyz;
        let g = direction[i].xyz;
        let q = image[i].xyz;
        products[0] += dot(g, q);
        products[1] += dot(g, b);
        if params.count == 2u {
            let other = second[i].xyz;
            products[2] += dot(other, q);
            products[3] += dot(other, second_image[i].xyz);
            products[4] += dot(other, b);
        }
    }
    for (var k = 0u; k < 5u; k += 1u) {
        let sum = sum_of_threads(local.x, products[k]);
        if local.x == 0u {
            sums[params.first + 8u * group.x + k] = sum;
        }
    }
}
