// The normal n = scale f1 x f2 of a triangle with the columns f1 and f2 of F: a unit vector, shorter only for
// crushed triangles. Its length falls below about the share `crushed` of the rest area.

struct Normal {
    // m = f1 x f2, and m^2 + crushed^2.
    m: vec3<f32>,
    squared: f32,
    scale: f32,
}

fn normal_of(m: vec3<f32>, crushed: f32) -> Normal {
    var normal: Normal;
    normal.m = m;
    normal.squared = dot(m, m) + crushed * crushed;
    normal.scale = sqrt((1.0 + crushed * crushed) / normal.squared);
    return normal;
}

// The factors a_ep of the residuals r_e = sum_p a_ep x_p - c_e n: the jumps less the shares of f1 and f2.
fn factors_of(bend: Bend) -> array<f32, 18> {
    var factors = bend.jumps;
    for (var edge = 0u; edge < 3u; edge += 1u) {
        let along = bend.rest[3u * edge];
        let beside = bend.rest[3u * edge + 1u];
        let first = along * bend.gradients[0] + beside * bend.gradients[1];
        let second = along * bend.gradients[2] + beside * bend.gradients[3];
        factors[6u * edge] += first + second;
        factors[6u * edge + 1u] -= first;
        factors[6u * edge + 2u] -= second;
    }
    return factors;
}
