// Hessians of tetrahedra of constant strain without damping: the crate bowknot-dynamics, elements/tetrahedron.rs and
// elements/solid_law.rs. F = u diag(s) v^T with rotations u and v; increments of F are d_ij along u_i v_j^T.

const ORDER: u32 = 3u;

// Columns whose angle has a smaller cosine count as orthogonal.
const ORTHOGONAL: f32 = 3e-7;

const SVD_SWEEPS: u32 = 8u;

@group(0) @binding(1) var<storage, read> tetrahedra: array<Tetrahedron>;

// The columns of F V, made orthogonal by one-sided Jacobi rotations, and V (Demmel and Veselic 1992); sorted by length.
struct Decomposition {
    b: array<vec3<f32>, 3>,
    v: array<vec3<f32>, 3>,
}

fn decompose(f: array<vec3<f32>, 3>) -> Decomposition {
    var out: Decomposition;
    out.b = f;
    out.v[0] = vec3<f32>(1.0, 0.0, 0.0);
    out.v[1] = vec3<f32>(0.0, 1.0, 0.0);
    out.v[2] = vec3<f32>(0.0, 0.0, 1.0);
    for (var sweep = 0u; sweep < SVD_SWEEPS; sweep += 1u) {
        for (var pair = 0u; pair < 3u; pair += 1u) {
            let p = pair / 2u;
            let q = 1u + (pair + 1u) / 2u;
            let pp = dot(out.b[p], out.b[p]);
            let qq = dot(out.b[q], out.b[q]);
            let pq = dot(out.b[p], out.b[q]);
            if pq * pq > ORTHOGONAL * ORTHOGONAL * pp * qq {
                let tau = (qq - pp) / (2.0 * pq);
                let size = 1.0 / (abs(tau) + sqrt(1.0 + tau * tau));
                let t = select(-size, size, tau >= 0.0);
                let c = 1.0 / sqrt(1.0 + t * t);
                let s = t * c;
                let x = out.b[p];
                let y = out.b[q];
                out.b[p] = c * x - s * y;
                out.b[q] = s * x + c * y;
                let z = out.v[p];
                let w = out.v[q];
                out.v[p] = c * z - s * w;
                out.v[q] = s * z + c * w;
            }
        }
    }
    // A swap changes one sign, so that v stays a rotation.
    for (var k = 0u; k < 3u; k += 1u) {
        let p = k % 2u;
        let q = p + 1u;
        if dot(out.b[p], out.b[p]) < dot(out.b[q], out.b[q]) {
            let x = out.b[p];
            out.b[p] = out.b[q];
            out.b[q] = -x;
            let z = out.v[p];
            out.v[p] = out.v[q];
            out.v[q] = -z;
        }
    }
    return out;
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        var tet = tetrahedra[e];
        var f: array<vec3<f32>, 3>;
        for (var a = 0u; a < 3u; a += 1u) {
            let edge = way(tet.nodes[0], tet.nodes[a + 1u]);
            for (var k = 0u; k < 3u; k += 1u) {
                f[k] += edge * tet.gradients[3u * a + k];
            }
        }
        var svd = decompose(f);
        let s1 = length(svd.b[0]);
        var u1 = vec3<f32>(1.0, 0.0, 0.0);
        if s1 > TINY {
            u1 = svd.b[0] / s1;
        }
        let rest = svd.b[1] - u1 * dot(u1, svd.b[1]);
        let s2 = length(rest);
        var u2 = any_normal(u1);
        if s2 > 1e-6 * s1 && s2 > TINY {
            u2 = rest / s2;
        }
        let u3 = cross(u1, u2);
        let s = vec3<f32>(s1, dot(u2, svd.b[1]), dot(u3, svd.b[2]));

        // Principal curvatures: see solid_law.rs. Entry k of flip and twist belongs to the two other indices.
        var scaling: array<f32, 9>;
        var flip: vec3<f32>;
        var twist: vec3<f32>;
        if tet.law == 0u {
            let strain = 0.5 * (s - 1.0) * (s + 1.0);
            let pressure = tet.lambda * (strain.x + strain.y + strain.z);
            for (var i = 0u; i < 3u; i += 1u) {
                for (var j = 0u; j < 3u; j += 1u) {
                    scaling[3u * i + j] = tet.lambda * s[i] * s[j];
                }
                scaling[4u * i] += tet.mu * (3.0 * s[i] * s[i] - 1.0) + pressure;
                let a = s[(i + 1u) % 3u];
                let b = s[(i + 2u) % 3u];
                flip[i] = tet.mu * (a * a + a * b + b * b - 1.0) + pressure;
                twist[i] = tet.mu * (a * a - a * b + b * b - 1.0) + pressure;
            }
        } else {
            let invariant = dot(s, s) + 1.0;
            let shear = tet.mu * (1.0 - 1.0 / invariant);
            let cofactor = vec3<f32>(s.y * s.z, s.z * s.x, s.x * s.y);
            let pressure = tet.lambda * (s.x * s.y * s.z - 1.0) - 0.75 * tet.mu;
            for (var i = 0u; i < 3u; i += 1u) {
                for (var j = 0u; j < 3u; j += 1u) {
                    var value = 2.0 * tet.mu / (invariant * invariant) * s[i] * s[j]
                        + tet.lambda * cofactor[i] * cofactor[j];
                    if i == j {
                        value += shear;
                    } else {
                        value += pressure * s[3u - i - j];
                    }
                    scaling[3u * i + j] = value;
                }
                flip[i] = shear - pressure * s[i];
                twist[i] = shear + pressure * s[i];
            }
        }
        scaling = filtered_matrix(scaling);
        var even: vec3<f32>;
        var odd: vec3<f32>;
        for (var k = 0u; k < 3u; k += 1u) {
            let a = filtered(flip[k]);
            let b = filtered(twist[k]);
            even[k] = 0.5 * (a + b);
            odd[k] = 0.5 * (a - b);
        }

        // Shape function gradients along v1, v2, v3.
        var shape: array<vec3<f32>, 4>;
        for (var a = 0u; a < 3u; a += 1u) {
            let g = vec3<f32>(tet.gradients[3u * a], tet.gradients[3u * a + 1u], tet.gradients[3u * a + 2u]);
            shape[a + 1u] = vec3<f32>(dot(g, svd.v[0]), dot(g, svd.v[1]), dot(g, svd.v[2]));
        }
        shape[0] = -(shape[1] + shape[2] + shape[3]);
        var u = array<vec3<f32>, 3>(u1, u2, u3);
        var block = 6u * e;
        for (var a = 0u; a < 4u; a += 1u) {
            for (var b = a + 1u; b < 4u; b += 1u) {
                let g = shape[a];
                let h = shape[b];
                // d_ij d_kl has a curvature where i = k, j = l (even), i = l, j = k (odd), i = j, k = l (scaling).
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
