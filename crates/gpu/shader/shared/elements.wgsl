// What all kernels of elements share: see assembly/layout.rs.

struct Membrane {
    nodes: array<u32, 3>,
    area: f32,
    gradients: array<f32, 4>,
    stiffness: array<f32, 4>,
    damping: f32,
    padding: array<u32, 3>,
}

struct Bend {
    nodes: array<u32, 6>,
    jumps: array<f32, 18>,
    gram: array<f32, 9>,
    gradients: array<f32, 4>,
    rest: array<f32, 9>,
    crushed: f32,
    padding: u32,
}

struct Tetrahedron {
    nodes: array<u32, 4>,
    gradients: array<f32, 9>,
    volume: f32,
    lambda: f32,
    mu: f32,
    law: u32,
    viscous_lambda: f32,
    viscous_mu: f32,
    padding: u32,
}

const NONE: u32 = 0xffffffffu;

// Lengths up to this count as zero.
const TINY: f32 = 1e-18;

// Divisors that are ratios of lengths are at least this large. It limits the curvatures of elements crushed
// to less than a twentieth.
const MIN_RATIO: f32 = 0.05;

// The unit eigenvector (c, s) of the larger eigenvalue of [[a, b], [b, d]]: a Jacobi rotation.
fn first_axis(a: f32, d: f32, b: f32) -> vec2<f32> {
    var c = 1.0;
    var s = 0.0;
    if abs(b) > 1e-9 * (abs(a) + abs(d)) {
        let tau = (d - a) / (2.0 * b);
        let size = 1.0 / (abs(tau) + sqrt(1.0 + tau * tau));
        let t = select(-size, size, tau >= 0.0);
        c = 1.0 / sqrt(1.0 + t * t);
        s = -t * c;
    }
    let along = c * c * a + 2.0 * c * s * b + s * s * d;
    let across = s * s * a - 2.0 * c * s * b + c * c * d;
    if along >= across {
        return vec2<f32>(c, s);
    }
    return vec2<f32>(-s, c);
}

// A unit vector orthogonal to the unit vector u.
fn any_normal(u: vec3<f32>) -> vec3<f32> {
    if abs(u.x) < 0.6 {
        return normalize(vec3<f32>(0.0, u.z, -u.y));
    }
    return normalize(vec3<f32>(-u.z, 0.0, u.x));
}
