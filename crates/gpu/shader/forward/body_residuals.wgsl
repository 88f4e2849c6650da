// Parts: types.
//
// The residuals of each body from those of its blocks, which follow each other: the length of the mean
// residual, and the mean length.

struct Params {
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<Block>;
@group(0) @binding(2) var<storage, read> sums: array<BlockSum>;
@group(0) @binding(3) var<storage, read_write> control: Control;

var<workgroup> shared_sums: array<BlockSum, 64>;

fn joined(a: BlockSum, b: BlockSum) -> BlockSum {
    var sum = a;
    sum.residual += b.residual;
    sum.mass += b.mass;
    sum.lengths += b.lengths;
    return sum;
}

// A workgroup per body, that of its first block: its threads take every 64th block, then add what they have
// by halves.
@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    for (var b = group.x; b < params.blocks; b += MOST_WORKGROUPS) {
        let body = blocks[b].body;
        if b > 0u && blocks[b - 1u].body == body {
            continue;
        }
        var own = BlockSum();
        for (var k = b + local.x; k < params.blocks && blocks[k].body == body; k += 64u) {
            own = joined(own, sums[k]);
        }
        shared_sums[local.x] = own;
        for (var reach = 32u; reach > 0u; reach /= 2u) {
            workgroupBarrier();
            if local.x < reach {
                shared_sums[local.x] = joined(shared_sums[local.x], shared_sums[local.x + reach]);
            }
        }
        let sum = shared_sums[0];
        if local.x == 0u && sum.mass > 0.0 {
            let net = sqrt(dot(sum.residual, sum.residual)) / sum.mass;
            atomicMax(&control.net_residual, bitcast<u32>(net));
            atomicMax(&control.mean_residual, bitcast<u32>(sum.lengths / sum.mass));
        }
        workgroupBarrier();
    }
}
