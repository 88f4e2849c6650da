// Parts: linear, sum.
//
// The image q = H p of the search direction, and p . q by workgroup: see linear/matrix.rs for how H lies.
// Rows multiply differences p_j - p_i, so that rounding of H acts on deformations alone. Rows of strands
// start from the image, which holds the product of strand_product.wgsl, and add the sum of the row.

struct Params {
    nodes: u32,
    springs: u32,
    workgroups: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> slices: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> words: array<u32>;
@group(0) @binding(3) var<storage, read> spring_words: array<u32>;
@group(0) @binding(4) var<storage, read> springs: array<Spring>;
@group(0) @binding(5) var<storage, read> direction: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> image: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> sums: array<f32>;
@group(0) @binding(8) var<storage, read_write> progress: Progress;

// Rows of a slice, and words of a block with its column.
const SLICE: u32 = 32u;
const BLOCK_WORDS: u32 = 10u;

var<workgroup> is_moving: u32;

fn number(at: u32) -> f32 {
    return bitcast<f32>(words[at]);
}

fn column_of_block(at: u32) -> vec3<f32> {
    return vec3<f32>(number(at), number(at + SLICE), number(at + 2u * SLICE));
}

// The reaction of a spring: its Hessian times the weighted sum of p over its nodes. Each of them computes it,
// which saves a dispatch.
fn reaction(spring: Spring) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        sum += spring.weights[k] * direction[spring.nodes[k]].xyz;
    }
    return spring.hessian[0].xyz * sum.x + spring.hessian[1].xyz * sum.y + spring.hessian[2].xyz * sum.z;
}

fn row(i: u32) -> vec3<f32> {
    let slice = slices[i / SLICE];
    let own = direction[i].xyz;
    var sum = vec3<f32>(0.0);
    var at = slice.x + i % SLICE;
    var blocks = slice.y;
    if (slice.w >> (i % SLICE) & 1u) == 1u {
        // Of strands the product is there already; blocks are for the preconditioner.
        sum = image[i].xyz;
        blocks = 1u;
    }
    for (var k = 0u; k < blocks; k += 1u) {
        // The first block is the sum of the row.
        var x = own;
        if k > 0u {
            x = direction[words[at]].xyz - own;
        }
        sum += column_of_block(at + SLICE) * x.x;
        sum += column_of_block(at + 4u * SLICE) * x.y;
        sum += column_of_block(at + 7u * SLICE) * x.z;
        at += BLOCK_WORDS * SLICE;
    }
    at = slice.x + i % SLICE + BLOCK_WORDS * SLICE * slice.y;
    for (var k = 0u; k < slice.z; k += 1u) {
        sum += number(at + SLICE) * (direction[words[at]].xyz - own);
        at += 2u * SLICE;
    }
    if params.springs > 0u {
        let end = spring_words[i + 1u];
        for (var e = spring_words[i]; e < end; e += 2u) {
            sum += bitcast<f32>(spring_words[e + 1u]) * reaction(springs[spring_words[e]]);
        }
    }
    return sum;
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        is_moving = atomicLoad(&progress.moving);
    }
    if workgroupUniformLoad(&is_moving) == 0u {
        return;
    }
    var curvature = 0.0;
    for (var i = THREADS * group.x + local.x; i < params.nodes; i += THREADS * params.workgroups) {
        let product = row(i);
        image[i] = vec4<f32>(product, 0.0);
        curvature += dot(direction[i].xyz, product);
    }
    let sum = sum_of_threads(local.x, curvature);
    if local.x == 0u {
        sums[group.x] = sum;
    }
}
