// Parts: elements, blocks, normal.
//
// Gauss-Newton Hessians of bending around triangles that are curved at rest: the crate bowknot-dynamics,
// elements/shell.rs. The residual r_e of an edge has the derivatives a_ep I - c_e T_p, with T_p = g_p1 dn/df1
// + g_p2 dn/df2 for the corners p and 0 for the other nodes. A block is sum_ef g_ef (a_ep I - c_e T_p)^T
// (a_fq I - c_f T_q).

@group(0) @binding(1) var<storage, read> bends: array<Bend>;

// The matrix of v -> a x v.
fn cross_matrix(a: vec3<f32>) -> mat3x3<f32> {
    return mat3x3<f32>(vec3<f32>(0.0, a.z, -a.y), vec3<f32>(-a.z, 0.0, a.x), vec3<f32>(a.y, -a.x, 0.0));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        var bend = bends[e];
        let e1 = way(bend.nodes[0], bend.nodes[1]);
        let e2 = way(bend.nodes[0], bend.nodes[2]);
        let f1 = e1 * bend.gradients[0] + e2 * bend.gradients[2];
        let f2 = e1 * bend.gradients[1] + e2 * bend.gradients[3];
        let normal = normal_of(cross(f1, f2), bend.crushed);
        let m = normal.m;
        let squared = normal.squared;
        let scale = normal.scale;
        // dn/dm = scale (I - m m^T / (m^2 + crushed^2)).
        var across: mat3x3<f32>;
        for (var k = 0u; k < 3u; k += 1u) {
            var column = m * (-m[k] / squared);
            column[k] += 1.0;
            across[k] = column * scale;
        }
        let by_f1 = across * cross_matrix(-f2);
        let by_f2 = across * cross_matrix(f1);
        var turns: array<mat3x3<f32>, 3>;
        turns[1] = by_f1 * bend.gradients[0] + by_f2 * bend.gradients[1];
        turns[2] = by_f1 * bend.gradients[2] + by_f2 * bend.gradients[3];
        turns[0] = (turns[1] + turns[2]) * -1.0;
        var factors = factors_of(bend);
        var block = 15u * e;
        for (var p = 0u; p < 6u; p += 1u) {
            for (var q = p + 1u; q < 6u; q += 1u) {
                var both = 0.0;
                var left = 0.0;
                var right = 0.0;
                var none = 0.0;
                for (var i = 0u; i < 3u; i += 1u) {
                    for (var j = 0u; j < 3u; j += 1u) {
                        let g = bend.gram[3u * i + j];
                        let ci = bend.rest[3u * i + 2u];
                        let cj = bend.rest[3u * j + 2u];
                        both += g * factors[6u * i + p] * factors[6u * j + q];
                        left += g * factors[6u * i + p] * cj;
                        right += g * ci * factors[6u * j + q];
                        none += g * ci * cj;
                    }
                }
                var sum = mat3x3<f32>(vec3<f32>(both, 0.0, 0.0), vec3<f32>(0.0, both, 0.0), vec3<f32>(0.0, 0.0, both));
                if q < 3u {
                    sum += turns[q] * -left + transpose(turns[p]) * turns[q] * none;
                }
                if p < 3u {
                    sum += transpose(turns[p]) * -right;
                }
                put(block, sum[0], sum[1], sum[2]);
                block += 1u;
            }
        }
    }
}
