// The data that the stages of Newton's method share: see newton/layout.rs.

// How far a linear solve is. Norms are squared, and those of vectors times the factor.
struct Solve {
    // A power of two that makes the largest force nearly 1, and its inverse.
    factor: f32,
    inverse: f32,
    // Of b; of the residual at the start of the last round and at its end; where the solve may end.
    scale: f32,
    before: f32,
    norm: f32,
    goal: f32,
    // Where the last batch of iterations ended.
    reached: f32,
    iterations: u32,
    // 1 after the last iteration of a round, and before the first one.
    ended: u32,
}

fn is_positive(number: f32) -> bool {
    return number > 0.0 && (bitcast<u32>(number) & 0x7f800000u) != 0x7f800000u;
}

fn largest_component(v: vec3<f32>) -> f32 {
    let a = abs(v);
    return max(a.x, max(a.y, a.z));
}
