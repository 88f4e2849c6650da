// The quadratic terms of the potential: see potential/layout.rs.

struct Terms {
    // R: xx, xy, xz, yy, yz, zz.
    row_sum: array<f32, 6>,
    // c.
    linear: array<f32, 3>,
}

// An entry of K.
struct Pair {
    node: u32,
    value: f32,
}

fn row_sum_times(i: u32, x: vec3<f32>) -> vec3<f32> {
    let r = terms[i].row_sum;
    return vec3<f32>(
        r[0] * x.x + r[1] * x.y + r[2] * x.z,
        r[1] * x.x + r[3] * x.y + r[4] * x.z,
        r[2] * x.x + r[4] * x.y + r[5] * x.z,
    );
}

fn linear_term(i: u32) -> vec3<f32> {
    let c = terms[i].linear;
    return vec3<f32>(c[0], c[1], c[2]);
}
