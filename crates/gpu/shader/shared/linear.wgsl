// The data that the stages of a linear solve share: see linear/layout.rs.

const NONE: u32 = 0xffffffffu;

struct Progress {
    moving: atomic<u32>,
    iterations: atomic<u32>,
    goal: f32,
}

struct PatchSlot {
    node: u32,
    factors: array<f32, 6>,
    arm: array<f32, 3>,
    link: array<f32, 2>,
}

// Numbers of the inverse of a domain.
const DOMAIN_WORDS: u32 = 2304u;

struct Spring {
    nodes: vec4<u32>,
    weights: vec4<f32>,
    // By columns; the fourth numbers are the components of the force.
    hessian: array<vec4<f32>, 3>,
}
