// Parts: elements, parts, energies, triangle.
//
// Energies of triangles of constant strain: the crate bowknot-dynamics, elements/woven.rs, where U - I = (C +
// J I)/r - I with C = F^T F, J = |f0 x f1|, r^2 = tr C + 2 J. From the change (d0, d1) of F follow those of
// C, J and r, and from them that of U, without cancellation. The energy is quadratic: its change is the
// stress of the mean strain times that of U.

@group(0) @binding(1) var<storage, read> membranes: array<Membrane>;

// The sizes of the stresses of strains of these sizes.
fn stress_size(stiffness: array<f32, 4>, strain: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        abs(stiffness[0]) * strain.x + abs(stiffness[1]) * strain.y,
        abs(stiffness[1]) * strain.x + abs(stiffness[2]) * strain.y,
        2.0 * abs(stiffness[3]) * strain.z,
    );
}

// The product of a stress and a strain, both by components 11, 22, 12.
fn work(stress: vec3<f32>, strain: vec3<f32>) -> f32 {
    return stress.x * strain.x + stress.y * strain.y + 2.0 * stress.z * strain.z;
}

// The energy at the reference, its change, and its size.
fn energy(m: Membrane) -> vec4<f32> {
    let g = m.gradients;
    let e1 = way(m.nodes[0], m.nodes[1]);
    let e2 = way(m.nodes[0], m.nodes[2]);
    let f0 = e1 * g[0] + e2 * g[2];
    let f1 = e1 * g[1] + e2 * g[3];
    let b1 = change(m.nodes[0], m.nodes[1]);
    let b2 = change(m.nodes[0], m.nodes[2]);
    let d0 = b1 * g[0] + b2 * g[2];
    let d1 = b1 * g[1] + b2 * g[3];
    let t0 = f0 + d0;
    let t1 = f1 + d1;

    let c = vec3<f32>(dot(f0, f0), dot(f1, f1), dot(f0, f1));
    let dc = vec3<f32>(dot(d0, f0 + t0), dot(d1, f1 + t1), dot(d0, t1) + dot(f0, d1));
    let normal = cross(f0, f1);
    let turn = cross(d0, t1) + cross(f0, d1);
    let j = length(normal);
    let both = j + length(normal + turn);
    var dj = 0.0;
    if both > TINY {
        dj = dot(turn, 2.0 * normal + turn) / both;
    }
    let r = sqrt(c.x + c.y + 2.0 * j);
    let r_trial = sqrt(max(dot(t0, t0) + dot(t1, t1) + 2.0 * length(normal + turn), 0.0));
    var u = vec3<f32>(0.0);
    if r > TINY {
        u = vec3<f32>(c.x + j, c.y + j, c.z) / r;
    }
    var du = -u;
    var size = u;
    if r_trial > TINY {
        let dr = (dc.x + dc.y + 2.0 * dj) / (r + r_trial);
        du = (dc + vec3<f32>(dj, dj, 0.0) - u * dr) / r_trial;
        let l0 = length(d0);
        let l1 = length(d1);
        let across = l0 * length(t1) + length(f0) * l1;
        let sizes = vec3<f32>(l0 * length(f0 + t0), l1 * length(f1 + t1), across);
        let dr_size = (sizes.x + sizes.y + 2.0 * across) / (r + r_trial);
        size = (sizes + vec3<f32>(across, across, 0.0) + abs(u) * dr_size) / r_trial;
    }
    let strain = u - vec3<f32>(1.0, 1.0, 0.0);
    let mean = strain + 0.5 * du;
    var out = vec3<f32>(
        0.5 * work(stress_of(m.stiffness, strain), strain),
        work(stress_of(m.stiffness, mean), du),
        work(stress_size(m.stiffness, abs(mean) + 1.0), abs(size)),
    );
    if m.damping > 0.0 && params.rate > 0.0 {
        let factor = m.damping * params.rate;
        let a1 = moved(m.nodes[0], m.nodes[1]);
        let a2 = moved(m.nodes[0], m.nodes[2]);
        let h0 = a1 * g[0] + a2 * g[2];
        let h1 = a1 * g[1] + a2 * g[3];
        let before = increment(f0, f1, h0, h1);
        let between = before + 0.25 * dc;
        let across = length(d0) * length(t1) + length(f0) * length(d1);
        let dc_size = vec3<f32>(length(d0) * length(f0 + t0), length(d1) * length(f1 + t1), across);
        let before_size = 0.5 * vec3<f32>(
            length(h0) * length(2.0 * f0 - h0),
            length(h1) * length(2.0 * f1 - h1),
            length(h0) * length(f1) + length(f0 - h0) * length(h1),
        );
        out += factor * vec3<f32>(
            0.5 * work(stress_of(m.stiffness, before), before),
            0.5 * work(stress_of(m.stiffness, between), dc),
            0.5 * work(stress_size(m.stiffness, before_size + 0.25 * dc_size), dc_size),
        );
    }
    return part(out * m.area);
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var sum = vec4<f32>(0.0);
    for (var e = THREADS * group.x + local.x; e < params.count; e += THREADS * params.workgroups) {
        sum += energy(membranes[e]);
    }
    put_part(group.x, local.x, sum);
}
