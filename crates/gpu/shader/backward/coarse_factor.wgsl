// Parts: types.
//
// The factor of the coarse correction: the maximizer of the dual along the ray of all multipliers, within
// bounds. The sums of the blocks, one per thread, are added by halves. Bounds and their reasons:
// `CoarseCorrection` (crates/twoway/src/coarse.rs).

struct Params {
    blocks: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> sums: array<vec2<f32>>;
// The factor, and by how much the multipliers of the call may still grow.
@group(0) @binding(2) var<storage, read_write> factor: array<f32>;

const LEAST: f32 = 0.3;
const MOST: f32 = 2.0;
// Quotients beyond this are out of bounds, whatever their divisor.
const LARGE: f32 = 1e6;

var<workgroup> shared_sums: array<vec2<f32>, 256>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    var own = vec2<f32>(0.0);
    if local.x < params.blocks {
        own = sums[local.x];
    }
    shared_sums[local.x] = own;
    for (var reach = 128u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if local.x < reach {
            shared_sums[local.x] += shared_sums[local.x + reach];
        }
    }
    if local.x != 0u {
        return;
    }
    let sum = shared_sums[0];
    var best = 1.0;
    if sum.y > 0.0 {
        // No multiplier acts where nothing has moved.
        if abs(sum.x) < LARGE * sum.y {
            best = 1.0 - sum.x / sum.y;
        } else if sum.x > 0.0 {
            best = LEAST;
        } else {
            best = MOST;
        }
    }
    let most = max(min(MOST, factor[1]), 1.0);
    let s = min(max(best, LEAST), most);
    factor[0] = s;
    factor[1] = factor[1] / s;
}
