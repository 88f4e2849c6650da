// Parts: elements, blocks, strain, solid, eigen.
//
// Hessians of tetrahedra of constant strain without damping: the crate bowknot-dynamics,
// elements/tetrahedron.rs and elements/solid_law.rs. F = u diag(s) v^T with rotations u and v; increments of
// F are d_ij along u_i v_j^T. damped_tetrahedron_hessian.wgsl has those with damping.

const ORDER: u32 = 3u;

@group(0) @binding(1) var<storage, read> tetrahedra: array<Tetrahedron>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        let tet = tetrahedra[e];
        if tet.viscous_mu > 0.0 && params.rate > 0.0 {
            continue;
        }
        let svd = singular_of(deformation_of(tet));
        let curvatures = curvatures_of(tet, svd.s);
        var scaling = filtered_matrix(curvatures.scaling);
        var even: vec3<f32>;
        var odd: vec3<f32>;
        for (var k = 0u; k < 3u; k += 1u) {
            let a = filtered(curvatures.flip[k]);
            let b = filtered(curvatures.twist[k]);
            even[k] = 0.5 * (a + b);
            odd[k] = 0.5 * (a - b);
        }

        var shape = shape_of(tet, svd.v);
        var u = svd.u;
        var block = 6u * e;
        for (var a = 0u; a < 4u; a += 1u) {
            for (var b = a + 1u; b < 4u; b += 1u) {
                let g = shape[a];
                let h = shape[b];
                // d_ij d_kl has a curvature where i = k, j = l (even), i = l, j = k (odd), i = j, k = l
                // (scaling).
                var columns: array<vec3<f32>, 3>;
                for (var i = 0u; i < 3u; i += 1u) {
                    var row = vec3<f32>(0.0);
                    for (var j = 0u; j < 3u; j += 1u) {
                        var value = scaling[3u * i + j] * g[i] * h[j];
                        if i == j {
                            let x = (i + 1u) % 3u;
                            let y = (i + 2u) % 3u;
                            value += even[y] * g[x] * h[x] + even[x] * g[y] * h[y];
                        } else {
                            value += odd[3u - i - j] * h[i] * g[j];
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
