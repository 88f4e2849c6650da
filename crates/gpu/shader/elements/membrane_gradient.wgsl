// Parts: elements, gradients, triangle.
//
// Gradients of triangles of constant strain: the crate bowknot-dynamics, elements/woven.rs. With the stress T
// of the strain U - I in the frame v, the stress along u_i v_j^T is T_11, 2 T_12 s1 / (s1 + s2), 2 T_12 s2 /
// (s1 + s2), T_22, and that of damping F S = u diag(s) S.

@group(0) @binding(1) var<storage, read> membranes: array<Membrane>;

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
        let t = stress_in(m.stiffness, strain_of(x), x.c, x.s);
        let r = shares_of(x);
        // Along u1 v1^T, u1 v2^T, u2 v1^T, u2 v2^T.
        var p = vec4<f32>(t.x, 2.0 * t.z * r.x, 2.0 * t.z * r.y, t.y);
        if m.damping > 0.0 && params.rate > 0.0 {
            let b1 = moved(m.nodes[0], m.nodes[1]);
            let b2 = moved(m.nodes[0], m.nodes[2]);
            let strain = increment(f0, f1, b1 * g[0] + b2 * g[2], b1 * g[1] + b2 * g[3]);
            let viscous = stress_in(m.stiffness, strain, x.c, x.s) * (m.damping * params.rate);
            p += vec4<f32>(x.s1 * viscous.x, x.s1 * viscous.z, x.s2 * viscous.z, x.s2 * viscous.y);
        }
        // Shape function gradients along v1 and v2.
        let a = vec2<f32>(x.c * g[0] + x.s * g[1], x.c * g[1] - x.s * g[0]);
        let b = vec2<f32>(x.c * g[2] + x.s * g[3], x.c * g[3] - x.s * g[2]);
        let first = (x.u1 * (p.x * a.x + p.y * a.y) + x.u2 * (p.z * a.x + p.w * a.y)) * m.area;
        let second = (x.u1 * (p.x * b.x + p.y * b.y) + x.u2 * (p.z * b.x + p.w * b.y)) * m.area;
        put(3u * e, -(first + second));
        put(3u * e + 1u, first);
        put(3u * e + 2u, second);
    }
}
