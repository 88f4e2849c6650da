// Parts: elements, blocks, strain, solid, eigen.
//
// Hessians of damped tetrahedra of constant strain: the crate bowknot-dynamics, elements/tetrahedron.rs. As
// in tetrahedron_hessian.wgsl, with a potential of the increment of Green's strain since the start of the
// time step. It couples all increments d_ij, index 3 i + j, and the sum of both is filtered.

const ORDER: u32 = 9u;

@group(0) @binding(1) var<storage, read> tetrahedra: array<Tetrahedron>;

fn times_columns(m: array<vec3<f32>, 3>, v: vec3<f32>) -> vec3<f32> {
    return m[0] * v.x + m[1] * v.y + m[2] * v.z;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        let tet = tetrahedra[e];
        if !(tet.viscous_mu > 0.0 && params.rate > 0.0) {
            continue;
        }
        let f = deformation_of(tet);
        let d = moved_of(tet);
        var svd = singular_of(f);
        var s = svd.s;
        var curvatures = curvatures_of(tet, s);
        let lambda = tet.viscous_lambda * params.rate;
        let mu = tet.viscous_mu * params.rate;
        // F and its change along the axes v.
        var now: array<vec3<f32>, 3>;
        var change: array<vec3<f32>, 3>;
        for (var k = 0u; k < 3u; k += 1u) {
            now[k] = times_columns(f, svd.v[k]);
            change[k] = times_columns(d, svd.v[k]);
        }
        // The stress of damping.
        var viscous = law_stress(green_increment(now, change), lambda, mu);
        var curvature: array<f32, 81>;
        for (var i = 0u; i < 3u; i += 1u) {
            for (var j = 0u; j < 3u; j += 1u) {
                curvature[36u * i + 4u * j] += curvatures.scaling[3u * i + j] + lambda * s[i] * s[j];
                for (var k = 0u; k < 3u; k += 1u) {
                    curvature[9u * (3u * i + j) + 3u * i + k] += viscous[j][k];
                }
            }
            curvature[40u * i] += 2.0 * mu * s[i] * s[i];
        }
        for (var k = 0u; k < 3u; k += 1u) {
            let i = (k + 1u) % 3u;
            let j = (k + 2u) % 3u;
            let even = 0.5 * (curvatures.flip[k] + curvatures.twist[k]);
            let odd = 0.5 * (curvatures.flip[k] - curvatures.twist[k]);
            let ij = 3u * i + j;
            let ji = 3u * j + i;
            // dE_ij = (s_i d_ij + s_j d_ji) / 2; it counts twice in the norm.
            curvature[10u * ij] += even + mu * s[i] * s[i];
            curvature[10u * ji] += even + mu * s[j] * s[j];
            curvature[9u * ij + ji] += odd + mu * s[i] * s[j];
            curvature[9u * ji + ij] += odd + mu * s[i] * s[j];
        }
        curvature = filtered_matrix(curvature);

        var shape = shape_of(tet, svd.v);
        var u = svd.u;
        var block = 6u * e;
        for (var a = 0u; a < 4u; a += 1u) {
            for (var b = a + 1u; b < 4u; b += 1u) {
                let g = shape[a];
                let h = shape[b];
                var columns: array<vec3<f32>, 3>;
                for (var i = 0u; i < 3u; i += 1u) {
                    var row = vec3<f32>(0.0);
                    for (var j = 0u; j < 3u; j += 1u) {
                        var value = 0.0;
                        for (var k = 0u; k < 9u; k += 1u) {
                            value += g[k / 3u] * curvature[9u * (3u * i + k / 3u) + 3u * j + k % 3u] * h[k % 3u];
                        }
                        row += u[j] * (value * tet.volume);
                    }
                    for (var k = 0u; k < 3u; k += 1u) {
                        columns[k] += u[i] * row[k];
                    }
                }
                put(block, columns[0], columns[1], columns[2]);
                block += 1u;
            }
        }
    }
}
