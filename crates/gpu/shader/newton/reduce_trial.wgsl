// Parts: sum, largest.
//
// The results of trial_positions.wgsl over all workgroups. One workgroup.

struct Params {
    count: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> sums: array<f32>;
@group(0) @binding(2) var<storage, read_write> summary: array<f32>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    var part = 0.0;
    for (var k = t; k < params.count; k += THREADS) {
        part += sums[8u * k];
    }
    let sum = sum_of_threads(t, part);
    if t == 0u {
        summary[0] = sum;
    }
    for (var k = 1u; k < 5u; k += 1u) {
        let found = largest_of_parts(t, k, params.count, 8u);
        if t == 0u {
            summary[k] = found;
        }
    }
}
