// Parts: types, weights, pair.
//
// Limits the step sizes of the vertices of each candidate: each side may close a share of the gap, so that
// each stays in its own half-space.
//
// Rounding. Let u = 2^-24 and P the sum of the coordinates of the longest path of the pair. A path is off by
// 3 u P, the closing speed along n by 4 u P more, shares and step sizes round another four times: less than
// 16 u P for a side, and a position is rounded to the grid, by less than 1 in each coordinate, sqrt(3) along
// n. Both sides together: less than 4 + 32 u P; STEP and PATH_ROUNDING are larger.

struct Params {
    capacity: u32,
    // Share of a gap that a step may use up.
    damping: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(4) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(5) var<storage, read> separations: array<Separation>;
@group(0) @binding(6) var<storage, read> paths: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> alphas: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> control: Control;

const STEP: f32 = 8.0;
const PATH_ROUNDING: f32 = 3.814697265625e-6;

fn lower(v: u32, alpha: f32) {
    // Bits of numbers of at least 0 are ordered as the numbers are; NaN and negative numbers become 0.
    var bits = bitcast<u32>(alpha);
    if bits >= 0x7f800000u {
        bits = 0u;
    }
    atomicMin(&alphas[v], bits);
}

fn limit_pair(candidate: Candidate, separation: Separation) {
    let pair = pair_of(candidate);
    var longest = 0.0;
    var path: array<vec4<f32>, 4>;
    for (var k = 0u; k < pair.count; k += 1u) {
        path[k] = paths[pair.vertices[k]];
        longest = max(longest, abs(path[k].x) + abs(path[k].y) + abs(path[k].z));
    }
    if longest == 0.0 {
        return;
    }
    let rounding = STEP + PATH_ROUNDING * longest;
    // Written so that a width that is no number freezes the pair.
    if !(separation.width > 2.0 * rounding) {
        for (var k = 0u; k < pair.count; k += 1u) {
            lower(pair.vertices[k], 0.0);
        }
        atomicAdd(&control.frozen, 1u);
        return;
    }
    let allowed = max(params.damping * (separation.width - separation.min_separation) - rounding, 0.0);

    var closing: array<f32, 4>;
    var speeds = vec2<f32>(0.0);
    var extremes = vec2<f32>(-3.0e38);
    let group = vertices[pair.vertices[0]].group;
    var one_group = group != NONE;
    for (var k = 0u; k < pair.count; k += 1u) {
        let along = dot(separation.normal, path[k].xyz);
        let side = u32(k >= pair.side_a);
        closing[k] = select(along, -along, side == 0u);
        speeds[side] = max(speeds[side], closing[k]);
        extremes[side] = max(extremes[side], closing[k]);
        one_group = one_group && vertices[pair.vertices[k]].group == group;
    }
    if one_group {
        // All move by one fraction: only the difference of both sides closes the gap. A half-space does not
        // move.
        let total = extremes.x + select(extremes.y, 0.0, pair.side_a == pair.count);
        if total > allowed {
            for (var k = 0u; k < pair.count; k += 1u) {
                lower(pair.vertices[k], allowed / total * path[k].w);
            }
        }
        return;
    }
    let total = speeds.x + speeds.y;
    if total <= allowed {
        return;
    }
    for (var k = 0u; k < pair.count; k += 1u) {
        if closing[k] > 0.0 {
            let share = speeds[u32(k >= pair.side_a)] / total;
            lower(pair.vertices[k], min(allowed * share / closing[k], 1.0) * path[k].w);
        }
    }
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        limit_pair(candidates[c], separations[c]);
    }
}
