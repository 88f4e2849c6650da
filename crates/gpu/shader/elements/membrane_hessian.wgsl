// Parts: elements, blocks, triangle, eigen.
//
// Hessians of triangles of constant strain: the formulas of the crate bowknot-dynamics, elements/woven.rs,
// with F = s1 u1 v1^T + s2 u2 v2^T; increments of F are d_ij along u_i v_j^T and n v_j^T. Negative curvatures
// are filtered.

const ORDER: u32 = 4u;

@group(0) @binding(1) var<storage, read> membranes: array<Membrane>;

// Curvature over the strain components (11, 12, 22) in the frame v1 = (c, s), v2 = (-s, c).
fn turned(stiffness: array<f32, 4>, c: f32, s: f32) -> mat3x3<f32> {
    // Rows: strains (11, 22, 12) in the axes of the weave, by columns here.
    let a = vec3<f32>(c * c, s * s, c * s);
    let b = vec3<f32>(-2.0 * c * s, 2.0 * c * s, c * c - s * s);
    let d = vec3<f32>(s * s, c * c, -c * s);
    var sum: mat3x3<f32>;
    var turn = mat3x3<f32>(a, b, d);
    for (var k = 0u; k < 3u; k += 1u) {
        let x = turn[k];
        let image = vec3<f32>(
            stiffness[0] * x.x + stiffness[1] * x.y,
            stiffness[1] * x.x + stiffness[2] * x.y,
            4.0 * stiffness[3] * x.z,
        );
        sum[k] = vec3<f32>(dot(a, image), dot(b, image), dot(d, image));
    }
    return sum;
}

// A symmetric matrix (11, 22, 12) with its eigenvalues filtered.
fn filtered_2(m: vec3<f32>) -> vec3<f32> {
    let axis = first_axis(m.x, m.y, m.z);
    let c = axis.x;
    let s = axis.y;
    let along = filtered(c * c * m.x + 2.0 * c * s * m.z + s * s * m.y);
    let across = filtered(s * s * m.x - 2.0 * c * s * m.z + c * c * m.y);
    return vec3<f32>(
        c * c * along + s * s * across,
        s * s * along + c * c * across,
        c * s * (along - across),
    );
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        let m = membranes[e];
        let g = m.gradients;
        let e1 = way(m.nodes[0], m.nodes[1]);
        let e2 = way(m.nodes[0], m.nodes[2]);
        let f0 = e1 * g[0] + e2 * g[2];
        let f1 = e1 * g[1] + e2 * g[3];
        let x = stretch_of(f0, f1);
        let c = x.c;
        let s = x.s;
        let s1 = x.s1;
        let s2 = x.s2;
        let u1 = x.u1;
        let u2 = x.u2;
        let n = cross(u1, u2);

        // The stress of the strain U - I.
        let t = stress_in(m.stiffness, strain_of(x), c, s);
        let r = shares_of(x);
        let sum = s1 + s2;
        let divisor = max(sum, MIN_RATIO);
        var stiffness = turned(m.stiffness, c, s);
        // dU : C : dU over d11, d12, d21, d22.
        var weights = vec4<f32>(1.0, r.x, r.y, 1.0);
        var rates = vec4<f32>(0.0);
        var viscous = vec3<f32>(0.0);
        if m.damping > 0.0 && params.rate > 0.0 {
            let factor = m.damping * params.rate;
            let b1 = moved(m.nodes[0], m.nodes[1]);
            let b2 = moved(m.nodes[0], m.nodes[2]);
            let strain = increment(f0, f1, b1 * g[0] + b2 * g[2], b1 * g[1] + b2 * g[3]);
            viscous = stress_in(m.stiffness, strain, c, s) * factor;
            rates = vec4<f32>(s1, 0.5 * s1, 0.5 * s2, s2) * sqrt(factor);
        }
        var plane: array<f32, 16>;
        for (var i = 0u; i < 4u; i += 1u) {
            for (var j = 0u; j < 4u; j += 1u) {
                let k = stiffness[(j + 1u) / 2u][(i + 1u) / 2u];
                plane[4u * i + j] = (weights[i] * weights[j] + rates[i] * rates[j]) * k;
            }
        }
        // T : d2U. The only divisor is s1 + s2.
        let over = 1.0 / (divisor * divisor);
        let t12 = 2.0 * t.z / divisor;
        let q1 = s1 / divisor;
        let q2 = s2 / divisor;
        plane[1] += t12 * q2;
        plane[2] -= t12 * q2;
        plane[4] += t12 * q2;
        plane[5] += (t.y * (s2 + 2.0 * s1) - t.x * s1) * over;
        plane[6] -= (t.x * s2 + t.y * s1) * over;
        plane[7] -= t12 * q1;
        plane[8] -= t12 * q2;
        plane[9] -= (t.x * s2 + t.y * s1) * over;
        plane[10] += (t.x * (s1 + 2.0 * s2) - t.y * s2) * over;
        plane[11] += t12 * q1;
        plane[13] -= t12 * q1;
        plane[14] += t12 * q1;
        // Damping: the stress acts on the increments of both rows.
        for (var k = 0u; k < 16u; k += 10u) {
            plane[k] += viscous.x;
            plane[k + 1u] += viscous.z;
            plane[k + 4u] += viscous.z;
            plane[k + 5u] += viscous.y;
        }
        let normal = filtered_2(
            vec3<f32>(t.x / max(s1, MIN_RATIO), t.y / max(s2, MIN_RATIO), 2.0 * t.z / divisor) + viscous
        );
        plane = filtered_matrix(plane);

        // Shape function gradients along v1 and v2.
        var shape: array<vec2<f32>, 3>;
        shape[1] = vec2<f32>(c * g[0] + s * g[1], c * g[1] - s * g[0]);
        shape[2] = vec2<f32>(c * g[2] + s * g[3], c * g[3] - s * g[2]);
        shape[0] = -(shape[1] + shape[2]);
        for (var pair = 0u; pair < 3u; pair += 1u) {
            let a = shape[pair / 2u];
            let b = shape[1u + (pair + 1u) / 2u];
            var local: array<f32, 4>;
            for (var k = 0u; k < 4u; k += 1u) {
                // Rows 2 i and 2 i + 1, columns 2 j and 2 j + 1.
                let at = 8u * (k / 2u) + 2u * (k % 2u);
                local[k] = m.area * (a.x * (plane[at] * b.x + plane[at + 1u] * b.y)
                    + a.y * (plane[at + 4u] * b.x + plane[at + 5u] * b.y));
            }
            let across = m.area
                * (a.x * (normal.x * b.x + normal.z * b.y) + a.y * (normal.z * b.x + normal.y * b.y));
            var columns: array<vec3<f32>, 3>;
            for (var k = 0u; k < 3u; k += 1u) {
                columns[k] = u1 * (local[0] * u1[k] + local[1] * u2[k])
                    + u2 * (local[2] * u1[k] + local[3] * u2[k]) + n * (across * n[k]);
            }
            put(3u * e + pair, columns[0], columns[1], columns[2]);
        }
    }
}
