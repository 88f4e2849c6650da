// What the kernels of elements share: see assembly/layout.rs. An element writes the blocks of its Hessian that couple
// two of its nodes; those of one node follow, since translations store no energy.

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
    padding: array<u32, 3>,
}

struct ElementParams {
    elements: u32,
    first_block: u32,
    absolute: u32,
    rate: f32,
    quantum: f32,
}

@group(0) @binding(0) var<uniform> params: ElementParams;
@group(0) @binding(2) var<storage, read> positions: array<vec4<i32>>;
// At the start of the time step, for damping.
@group(0) @binding(3) var<storage, read> start: array<vec4<i32>>;
@group(0) @binding(4) var<storage, read_write> blocks: array<f32>;

// Lengths up to this count as zero.
const TINY: f32 = 1e-18;

// Divisors that are ratios of lengths are at least this large. It limits the curvatures of elements crushed to less
// than a twentieth.
const MIN_RATIO: f32 = 0.05;

fn way(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>(positions[b].xyz - positions[a].xyz) * params.quantum;
}

fn way_at_start(a: u32, b: u32) -> vec3<f32> {
    return vec3<f32>(start[b].xyz - start[a].xyz) * params.quantum;
}

fn filtered(curvature: f32) -> f32 {
    return select(max(curvature, 0.0), abs(curvature), params.absolute == 1u);
}

// Writes a block, given by its columns.
fn put(block: u32, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) {
    let at = 9u * (params.first_block + block);
    for (var k = 0u; k < 3u; k += 1u) {
        blocks[at + k] = a[k];
        blocks[at + 3u + k] = b[k];
        blocks[at + 6u + k] = c[k];
    }
}

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
