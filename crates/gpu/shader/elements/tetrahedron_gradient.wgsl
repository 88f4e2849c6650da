// Parts: elements, gradients, strain.
//
// Gradients of tetrahedra of constant strain: the crate bowknot-dynamics, elements/tetrahedron.rs and
// elements/solid_law.rs. The stress is F (2 mu E + lambda tr(E) I) or mu (1 - 1/(I + 1)) F + (lambda (J - 1)
// - 3/4 mu) dJ/dF, and that of damping F S of the increment of Green's strain.

@group(0) @binding(1) var<storage, read> tetrahedra: array<Tetrahedron>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        let tet = tetrahedra[e];
        let f = deformation_of(tet);
        // F S with a symmetric S, plus the rest of the stress.
        var s: mat3x3<f32>;
        var stress: mat3x3<f32>;
        if tet.law == 0u {
            s = law_stress(green_strain(f), tet.lambda, tet.mu);
        } else {
            let invariant = dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]) + 1.0;
            let shear = tet.mu * (1.0 - 1.0 / invariant);
            let across = cross(f[1], f[2]);
            let pressure = tet.lambda * (dot(f[0], across) - 1.0) - 0.75 * tet.mu;
            stress = mat3x3<f32>(
                f[0] * shear + across * pressure,
                f[1] * shear + cross(f[2], f[0]) * pressure,
                f[2] * shear + cross(f[0], f[1]) * pressure,
            );
        }
        if tet.viscous_mu > 0.0 && params.rate > 0.0 {
            let strain = green_increment(f, moved_of(tet));
            s += law_stress(strain, tet.viscous_lambda * params.rate, tet.viscous_mu * params.rate);
        }
        for (var k = 0u; k < 3u; k += 1u) {
            stress[k] += f[0] * s[k].x + f[1] * s[k].y + f[2] * s[k].z;
        }
        var rest = vec3<f32>(0.0);
        var gradients_at_rest = tet.gradients;
        for (var a = 0u; a < 3u; a += 1u) {
            let force = (stress[0] * gradients_at_rest[3u * a] + stress[1] * gradients_at_rest[3u * a + 1u]
                + stress[2] * gradients_at_rest[3u * a + 2u]) * tet.volume;
            put(4u * e + a + 1u, force);
            rest += force;
        }
        put(4u * e, -rest);
    }
}
