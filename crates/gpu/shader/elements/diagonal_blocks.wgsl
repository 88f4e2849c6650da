// The diagonal blocks of the matrix without springs: the sum of a row less its other blocks and entries.

struct Params {
    nodes: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> slices: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> words: array<u32>;
// xx, xy, xz, yy, yz, zz of each node.
@group(0) @binding(3) var<storage, read_write> diagonal: array<f32>;

const SLICE: u32 = 32u;
const BLOCK_WORDS: u32 = 10u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = id.x; i < params.nodes; i += 64u * MOST_WORKGROUPS) {
        let slice = slices[i / SLICE];
        var at = slice.x + i % SLICE;
        var sum: array<f32, 9>;
        for (var k = 0u; k < slice.y; k += 1u) {
            let sign = select(-1.0, 1.0, k == 0u);
            for (var c = 0u; c < 9u; c += 1u) {
                sum[c] += sign * bitcast<f32>(words[at + (1u + c) * SLICE]);
            }
            at += BLOCK_WORDS * SLICE;
        }
        var scalars = 0.0;
        for (var k = 0u; k < slice.z; k += 1u) {
            scalars += bitcast<f32>(words[at + SLICE]);
            at += 2u * SLICE;
        }
        diagonal[6u * i] = sum[0] - scalars;
        diagonal[6u * i + 1u] = 0.5 * (sum[1] + sum[3]);
        diagonal[6u * i + 2u] = 0.5 * (sum[2] + sum[6]);
        diagonal[6u * i + 3u] = sum[4] - scalars;
        diagonal[6u * i + 4u] = 0.5 * (sum[5] + sum[7]);
        diagonal[6u * i + 5u] = sum[8] - scalars;
    }
}
