// Parts: elements, gradients, normal.
//
// Gradients of bending around triangles that are curved at rest: the crate bowknot-dynamics,
// elements/shell.rs. With the stresses t_e = sum_f g_ef r_f it is sum_e a_ep t_e - T_p^T sum_e c_e t_e, see
// bend_hessian.wgsl.

@group(0) @binding(1) var<storage, read> bends: array<Bend>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        var bend = bends[e];
        var ways: array<vec3<f32>, 6>;
        for (var p = 1u; p < 6u; p += 1u) {
            if bend.nodes[p] != NONE {
                ways[p] = way(bend.nodes[0], bend.nodes[p]);
            }
        }
        let g = bend.gradients;
        let f1 = ways[1] * g[0] + ways[2] * g[2];
        let f2 = ways[1] * g[1] + ways[2] * g[3];
        let normal = normal_of(cross(f1, f2), bend.crushed);
        var factors = factors_of(bend);
        var residuals: array<vec3<f32>, 3>;
        for (var i = 0u; i < 3u; i += 1u) {
            var sum = normal.m * (-bend.rest[3u * i + 2u] * normal.scale);
            for (var p = 1u; p < 6u; p += 1u) {
                sum += ways[p] * factors[6u * i + p];
            }
            residuals[i] = sum;
        }
        var stresses: array<vec3<f32>, 3>;
        var turning = vec3<f32>(0.0);
        for (var i = 0u; i < 3u; i += 1u) {
            stresses[i] = residuals[0] * bend.gram[3u * i] + residuals[1] * bend.gram[3u * i + 1u]
                + residuals[2] * bend.gram[3u * i + 2u];
            turning += stresses[i] * bend.rest[3u * i + 2u];
        }
        // dn/dm times the sum of c_e t_e; dn/dm is symmetric.
        let across = (turning - normal.m * (dot(normal.m, turning) / normal.squared)) * normal.scale;
        let by_f1 = cross(f2, across);
        let by_f2 = cross(across, f1);
        var rest = vec3<f32>(0.0);
        for (var p = 1u; p < 6u; p += 1u) {
            var sum = stresses[0] * factors[p] + stresses[1] * factors[6u + p] + stresses[2] * factors[12u + p];
            if p < 3u {
                sum -= by_f1 * bend.gradients[2u * p - 2u] + by_f2 * bend.gradients[2u * p - 1u];
            }
            put(6u * e + p, sum);
            rest += sum;
        }
        put(6u * e, -rest);
    }
}
