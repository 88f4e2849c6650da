// What the kernels of the preconditioner's groups share: see assembly/layout.rs. A group moves as a rigid
// body: a node at the arm o from its center, over its size, moves by shift + spin x o.

struct Frame {
    center: vec3<i32>,
    // 0 for an empty group.
    size: f32,
    moment: array<f32, 6>,
    held: array<f32, 6>,
}

// The way between two places of the grid.
fn between(a: vec3<i32>, b: vec3<i32>, quantum: f32) -> vec3<f32> {
    return vec3<f32>(b - a) * quantum;
}

// H times the map from a spin to the displacement at an arm.
fn times_spin(h: mat3x3<f32>, arm: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(h[2] * arm.y - h[1] * arm.z, h[0] * arm.z - h[2] * arm.x, h[1] * arm.x - h[0] * arm.y);
}

// Moments of forces, which are columns, at an arm.
fn moments(arm: vec3<f32>, f: mat3x3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(cross(arm, f[0]), cross(arm, f[1]), cross(arm, f[2]));
}
