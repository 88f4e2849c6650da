// F = u diag(s) v^T of a tetrahedron, with rotations u and v, and the principal curvatures of its law.

// Columns whose angle has a smaller cosine count as orthogonal.
const ORTHOGONAL: f32 = 3e-7;

const SVD_SWEEPS: u32 = 8u;

// The columns of F V, made orthogonal by one-sided Jacobi rotations, and V (Demmel and Veselic 1992); sorted
// by length.
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

// F = u diag(s) v^T.
struct Singular {
    u: array<vec3<f32>, 3>,
    s: vec3<f32>,
    v: array<vec3<f32>, 3>,
}

fn singular_of(f: array<vec3<f32>, 3>) -> Singular {
    let svd = decompose(f);
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
    var out: Singular;
    out.u = array<vec3<f32>, 3>(u1, u2, u3);
    out.s = vec3<f32>(s1, dot(u2, svd.b[1]), dot(u3, svd.b[2]));
    out.v = svd.v;
    return out;
}

// See solid_law.rs of the crate bowknot-dynamics. Entry k of flip and twist belongs to the two other indices.
struct Curvatures {
    scaling: array<f32, 9>,
    flip: vec3<f32>,
    twist: vec3<f32>,
}

fn curvatures_of(tet: Tetrahedron, singular: vec3<f32>) -> Curvatures {
    var s = singular;
    var out: Curvatures;
    if tet.law == 0u {
        let strain = 0.5 * (s - 1.0) * (s + 1.0);
        let pressure = tet.lambda * (strain.x + strain.y + strain.z);
        for (var i = 0u; i < 3u; i += 1u) {
            for (var j = 0u; j < 3u; j += 1u) {
                out.scaling[3u * i + j] = tet.lambda * s[i] * s[j];
            }
            out.scaling[4u * i] += tet.mu * (3.0 * s[i] * s[i] - 1.0) + pressure;
            let a = s[(i + 1u) % 3u];
            let b = s[(i + 2u) % 3u];
            out.flip[i] = tet.mu * (a * a + a * b + b * b - 1.0) + pressure;
            out.twist[i] = tet.mu * (a * a - a * b + b * b - 1.0) + pressure;
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
                out.scaling[3u * i + j] = value;
            }
            out.flip[i] = shear - pressure * s[i];
            out.twist[i] = shear + pressure * s[i];
        }
    }
    return out;
}

// Gradients of the shape functions of all nodes along v1, v2, v3.
fn shape_of(tet: Tetrahedron, axes: array<vec3<f32>, 3>) -> array<vec3<f32>, 4> {
    var gradients = tet.gradients;
    var shape: array<vec3<f32>, 4>;
    for (var a = 0u; a < 3u; a += 1u) {
        let g = vec3<f32>(gradients[3u * a], gradients[3u * a + 1u], gradients[3u * a + 2u]);
        shape[a + 1u] = vec3<f32>(dot(g, axes[0]), dot(g, axes[1]), dot(g, axes[2]));
    }
    shape[0] = -(shape[1] + shape[2] + shape[3]);
    return shape;
}
