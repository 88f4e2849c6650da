// Triangles of constant strain: F = s1 u1 v1^T + s2 u2 v2^T with v1 = (c, s) and v2 = (-s, c).

struct Stretch {
    u1: vec3<f32>,
    u2: vec3<f32>,
    c: f32,
    s: f32,
    s1: f32,
    s2: f32,
}

fn stretch_of(f0: vec3<f32>, f1: vec3<f32>) -> Stretch {
    var x: Stretch;
    let axis = first_axis(dot(f0, f0), dot(f1, f1), dot(f0, f1));
    x.c = axis.x;
    x.s = axis.y;
    let w1 = f0 * x.c + f1 * x.s;
    x.s1 = length(w1);
    x.u1 = vec3<f32>(1.0, 0.0, 0.0);
    if x.s1 > TINY {
        x.u1 = w1 / x.s1;
    }
    var w2 = f1 * x.c - f0 * x.s;
    w2 -= x.u1 * dot(x.u1, w2);
    x.s2 = length(w2);
    x.u2 = any_normal(x.u1);
    if x.s2 > 1e-6 * x.s1 && x.s2 > TINY {
        x.u2 = w2 / x.s2;
    }
    return x;
}

// The strain U - I with U = V diag(s1, s2) V^T: components 11, 22, 12 in the axes of the weave.
fn strain_of(x: Stretch) -> vec3<f32> {
    let d1 = x.s1 - 1.0;
    let d2 = x.s2 - 1.0;
    return vec3<f32>(
        x.c * x.c * d1 + x.s * x.s * d2,
        x.s * x.s * d1 + x.c * x.c * d2,
        x.c * x.s * (d1 - d2),
    );
}

// The singular values over their sum.
fn shares_of(x: Stretch) -> vec2<f32> {
    let sum = x.s1 + x.s2;
    if sum > TINY {
        return vec2<f32>(x.s1 / sum, x.s2 / sum);
    }
    return vec2<f32>(0.5, 0.5);
}

// The stress of a strain, both by components 11, 22, 12 in the axes of the weave.
fn stress_of(stiffness: array<f32, 4>, strain: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        stiffness[0] * strain.x + stiffness[1] * strain.y,
        stiffness[1] * strain.x + stiffness[2] * strain.y,
        2.0 * stiffness[3] * strain.z,
    );
}

// The same, turned into the frame v.
fn stress_in(stiffness: array<f32, 4>, strain: vec3<f32>, c: f32, s: f32) -> vec3<f32> {
    let t = stress_of(stiffness, strain);
    return vec3<f32>(
        c * c * t.x + 2.0 * c * s * t.z + s * s * t.y,
        s * s * t.x - 2.0 * c * s * t.z + c * c * t.y,
        c * s * (t.y - t.x) + (c * c - s * s) * t.z,
    );
}

// The increment of Green's strain (11, 22, 12) to F = (f0, f1), which has changed by (d0, d1), without
// cancellation.
fn increment(f0: vec3<f32>, f1: vec3<f32>, d0: vec3<f32>, d1: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        0.5 * dot(d0, 2.0 * f0 - d0),
        0.5 * dot(d1, 2.0 * f1 - d1),
        0.5 * (dot(d0, f1) + dot(f0 - d0, d1)),
    );
}
