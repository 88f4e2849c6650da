// The residuals of each body from those of its blocks, which follow each other: the length of the mean residual, and the
// mean length.

struct Params {
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<Block>;
@group(0) @binding(2) var<storage, read> sums: array<BlockSum>;
@group(0) @binding(3) var<storage, read_write> control: Control;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var b = id.x; b < params.blocks; b += 64u * MOST_WORKGROUPS) {
        let body = blocks[b].body;
        // The first block of a body adds up the others.
        if b > 0u && blocks[b - 1u].body == body {
            continue;
        }
        var sum = sums[b];
        for (var k = b + 1u; k < params.blocks && blocks[k].body == body; k += 1u) {
            sum.residual += sums[k].residual;
            sum.mass += sums[k].mass;
            sum.lengths += sums[k].lengths;
        }
        if sum.mass > 0.0 {
            let net = sqrt(dot(sum.residual, sum.residual)) / sum.mass;
            atomicMax(&control.net_residual, bitcast<u32>(net));
            atomicMax(&control.mean_residual, bitcast<u32>(sum.lengths / sum.mass));
        }
    }
}
