// Parts: elements, parts, energies, strain, logarithm.
//
// Energies of tetrahedra of constant strain: the crate bowknot-dynamics, elements/solid_law.rs and
// elements/tetrahedron.rs. The change of St. Venant-Kirchhoff's energy and of the potential of damping, which
// are quadratic in Green's strain, is the stress of the mean strain times the change of the strain. Stable
// neo-Hookean: with the changes dI of |F|^2 and dJ of det F it is mu/2 (dI - log(1 + dI/(I + 1))) + (lambda
// (J + dJ/2 - 1) - 3/4 mu) dJ.

@group(0) @binding(1) var<storage, read> tetrahedra: array<Tetrahedron>;

fn product(a: mat3x3<f32>, b: mat3x3<f32>) -> f32 {
    return dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2]);
}

fn squared_norm(f: array<vec3<f32>, 3>) -> f32 {
    return dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]);
}

// Stable neo-Hookean energy density, accurate near rest.
fn density(tet: Tetrahedron, strain: mat3x3<f32>, j: f32) -> f32 {
    let trace = strain[0].x + strain[1].y + strain[2].z;
    let second = 0.5 * (trace * trace - product(strain, strain));
    let third = dot(strain[0], cross(strain[1], strain[2]));
    var grow = j - 1.0;
    var first_order = 2.0 * trace - 2.0 * grow;
    if j > 0.5 {
        grow = (2.0 * trace + 4.0 * second + 8.0 * third) / (j + 1.0);
        first_order = (2.0 * trace * grow - 8.0 * second - 16.0 * third) / (j + 1.0);
    }
    let half = 0.5 * trace;
    return 0.375 * tet.mu * first_order + 0.5 * tet.mu * (half - log_1p(half)) + 0.5 * tet.lambda * grow * grow;
}

// The energy at the reference, its change, and its size.
fn energy(tet: Tetrahedron) -> vec4<f32> {
    let n = tet.nodes;
    let f = deformation_of(tet);
    let d = columns_of(tet, change(n[0], n[1]), change(n[0], n[2]), change(n[0], n[3]));
    let t = array<vec3<f32>, 3>(f[0] + d[0], f[1] + d[1], f[2] + d[2]);
    let strain = green_strain(f);
    let turn = green_increment(t, d);
    // Norms of F, of its change, and of the changes of strain.
    let moves = sqrt(squared_norm(d));
    let large = sqrt(squared_norm(f)) + moves;
    let turn_size = moves * large;
    var out: vec3<f32>;
    if tet.law == 0u {
        let stress = law_stress(strain + turn * 0.5, tet.lambda, tet.mu);
        out = vec3<f32>(
            0.5 * product(law_stress(strain, tet.lambda, tet.mu), strain),
            product(stress, turn),
            (2.0 * tet.mu + 3.0 * tet.lambda) * 0.5 * (large * large + 3.0) * turn_size,
        );
    } else {
        let across = cross(f[1], f[2]);
        let across_change = cross(d[1], t[2]) + cross(f[1], d[2]);
        let j = dot(f[0], across);
        let dj = dot(d[0], across + across_change) + dot(f[0], across_change);
        let di = dot(d[0], f[0] + t[0]) + dot(d[1], f[1] + t[1]) + dot(d[2], f[2] + t[2]);
        let logarithm = log_1p(di / (squared_norm(f) + 1.0));
        let pressure = tet.lambda * (j + 0.5 * dj - 1.0) - 0.75 * tet.mu;
        // |det F| is at most (|F|^2 / 3)^(3/2), and its derivative |F|^2 / 3^(1/2).
        let pressure_size = tet.lambda * (0.2 * large * large * large + 1.0) + 0.75 * tet.mu;
        out = vec3<f32>(
            density(tet, strain, j),
            0.5 * tet.mu * (di - logarithm) + pressure * dj,
            2.0 * tet.mu * turn_size + pressure_size * 0.6 * large * turn_size,
        );
    }
    if tet.viscous_mu > 0.0 && params.rate > 0.0 {
        let h = moved_of(tet);
        let lambda = tet.viscous_lambda * params.rate;
        let mu = tet.viscous_mu * params.rate;
        let before = green_increment(f, h);
        let way_since = sqrt(squared_norm(h));
        out += vec3<f32>(
            0.5 * product(law_stress(before, lambda, mu), before),
            product(law_stress(before + turn * 0.5, lambda, mu), turn),
            (2.0 * mu + 3.0 * lambda) * (way_since * (large + way_since) + turn_size) * turn_size,
        );
    }
    return part(out * tet.volume);
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var sum = vec4<f32>(0.0);
    for (var e = THREADS * group.x + local.x; e < params.count; e += THREADS * params.workgroups) {
        sum += energy(tetrahedra[e]);
    }
    put_part(group.x, local.x, sum);
}
