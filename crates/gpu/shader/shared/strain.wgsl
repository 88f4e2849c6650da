// Deformation gradients and strains of tetrahedra, by columns.

// F, or a change of F, from the edges from node 0.
fn columns_of(tet: Tetrahedron, e1: vec3<f32>, e2: vec3<f32>, e3: vec3<f32>) -> array<vec3<f32>, 3> {
    let g = tet.gradients;
    return array<vec3<f32>, 3>(
        e1 * g[0] + e2 * g[3] + e3 * g[6],
        e1 * g[1] + e2 * g[4] + e3 * g[7],
        e1 * g[2] + e2 * g[5] + e3 * g[8],
    );
}

// F at the positions of a tetrahedron.
fn deformation_of(tet: Tetrahedron) -> array<vec3<f32>, 3> {
    let n = tet.nodes;
    return columns_of(tet, way(n[0], n[1]), way(n[0], n[2]), way(n[0], n[3]));
}

// The change of F since the start of the time step.
fn moved_of(tet: Tetrahedron) -> array<vec3<f32>, 3> {
    let n = tet.nodes;
    return columns_of(tet, moved(n[0], n[1]), moved(n[0], n[2]), moved(n[0], n[3]));
}

// Green's strain (F^T F - I) / 2.
fn green_strain(f: array<vec3<f32>, 3>) -> mat3x3<f32> {
    let xy = 0.5 * dot(f[0], f[1]);
    let xz = 0.5 * dot(f[0], f[2]);
    let yz = 0.5 * dot(f[1], f[2]);
    return mat3x3<f32>(
        vec3<f32>(0.5 * (dot(f[0], f[0]) - 1.0), xy, xz),
        vec3<f32>(xy, 0.5 * (dot(f[1], f[1]) - 1.0), yz),
        vec3<f32>(xz, yz, 0.5 * (dot(f[2], f[2]) - 1.0)),
    );
}

// The increment of Green's strain to F, which has changed by d, without cancellation.
fn green_increment(f: array<vec3<f32>, 3>, d: array<vec3<f32>, 3>) -> mat3x3<f32> {
    let a = 2.0 * f[0] - d[0];
    let b = 2.0 * f[1] - d[1];
    let c = 2.0 * f[2] - d[2];
    let xy = 0.25 * (dot(d[0], b) + dot(d[1], a));
    let xz = 0.25 * (dot(d[0], c) + dot(d[2], a));
    let yz = 0.25 * (dot(d[1], c) + dot(d[2], b));
    return mat3x3<f32>(
        vec3<f32>(0.5 * dot(d[0], a), xy, xz),
        vec3<f32>(xy, 0.5 * dot(d[1], b), yz),
        vec3<f32>(xz, yz, 0.5 * dot(d[2], c)),
    );
}

// 2 mu E + lambda tr(E) I.
fn law_stress(strain: mat3x3<f32>, lambda: f32, mu: f32) -> mat3x3<f32> {
    let pressure = lambda * (strain[0].x + strain[1].y + strain[2].z);
    return mat3x3<f32>(
        strain[0] * (2.0 * mu) + vec3<f32>(pressure, 0.0, 0.0),
        strain[1] * (2.0 * mu) + vec3<f32>(0.0, pressure, 0.0),
        strain[2] * (2.0 * mu) + vec3<f32>(0.0, 0.0, pressure),
    );
}
