// Parts: linear, sum, largest, newton.
//
// What a linear solve knows of itself: its unit, its norms, and the norm at which it ends. One workgroup.

struct Params {
    // What is settled.
    mode: u32,
    // Where partial sums begin, and their number.
    first: u32,
    count: u32,
    // Squared, relative to b and the smallest scale, and to b alone.
    tolerance: f32,
    own_tolerance: f32,
    min_scale: f32,
}

// The factor from the largest numbers of b; the norm of b; the norm at the start; that after a round.
const FACTOR: u32 = 0u;
const SCALE: u32 = 1u;
const START: u32 = 2u;
const ROUND: u32 = 3u;

// Share of the goal at which iterations end, squared: the residual that is computed afterwards shall be below
// it as well.
const MARGIN: f32 = 0.9025;

// Largest reduction of a squared norm by a round: rounding comes near then.
const MAX_REDUCTION: f32 = 1e-10;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> sums: array<f32>;
@group(0) @binding(2) var<storage, read_write> solve: Solve;
@group(0) @binding(3) var<storage, read_write> progress: Progress;
@group(0) @binding(4) var<storage, read_write> ended: Progress;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    let t = local.x;
    if params.mode == FACTOR {
        let largest = largest_of_parts(t, params.first, params.count, 1u);
        if t == 0u {
            let bits = bitcast<u32>(largest) & 0x7f800000u;
            // Of exponents that are neither the smallest nor the two largest ones the inverse is a number,
            // too.
            let is_usual = bits > 0u && bits < 0x7f000000u;
            solve.factor = bitcast<f32>(select(0x3f800000u, 0x7f000000u - bits, is_usual));
            solve.inverse = bitcast<f32>(select(0x3f800000u, bits, is_usual));
        }
        return;
    }
    let norm = sum_of_parts(t, params.first, params.count);
    if t != 0u {
        return;
    }
    if params.mode == SCALE {
        solve.scale = norm;
        return;
    }
    if params.mode == START {
        // Zero times a square that is too large would be no number.
        var relative = solve.scale;
        if params.min_scale > 0.0 {
            relative = max(relative, params.min_scale * solve.factor * solve.factor);
        }
        solve.goal = max(params.tolerance * relative, params.own_tolerance * solve.scale);
        solve.norm = norm;
        solve.reached = norm;
        solve.iterations = 0u;
        solve.ended = 0u;
        progress.goal = max(MARGIN * solve.goal, MAX_REDUCTION * norm);
        atomicStore(&progress.moving, 1u);
        atomicStore(&progress.iterations, 0u);
        atomicStore(&ended.moving, 0u);
        return;
    }
    solve.iterations = atomicLoad(&progress.iterations);
    // Of a round that goes on, the partial sums are those of the last iteration.
    solve.reached = norm;
    if solve.ended == 1u {
        solve.before = solve.norm;
        solve.norm = norm;
        progress.goal = max(MARGIN * solve.goal, MAX_REDUCTION * norm);
        atomicStore(&progress.moving, 1u);
    }
}
