// The factor of the coarse correction: the maximizer of the dual along the ray of all multipliers, within bounds. The sums
// of the blocks are added in their order. Bounds and their reasons: `CoarseCorrection` (crates/twoway/src/coarse.rs).

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

@compute @workgroup_size(1)
fn main() {
    var sum = vec2<f32>(0.0);
    for (var block = 0u; block < params.blocks; block += 1u) {
        sum += sums[block];
    }
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
