// Parts: elements, parts, energies, normal.
//
// Energies of bending around triangles that are curved at rest: the crate bowknot-dynamics,
// elements/shell.rs. The energy is quadratic in the residuals r_e: its change is the sum over e of the stress
// of the mean residual times the change of r_e, which follows from that of the normal without cancellation.

@group(0) @binding(1) var<storage, read> bends: array<Bend>;

// The energy at the reference, its change, and its size.
fn energy(element: Bend) -> vec4<f32> {
    var bend = element;
    var ways: array<vec3<f32>, 6>;
    var changes: array<vec3<f32>, 6>;
    for (var p = 1u; p < 6u; p += 1u) {
        if bend.nodes[p] != NONE {
            ways[p] = way(bend.nodes[0], bend.nodes[p]);
            changes[p] = change(bend.nodes[0], bend.nodes[p]);
        }
    }
    let g = bend.gradients;
    let f1 = ways[1] * g[0] + ways[2] * g[2];
    let f2 = ways[1] * g[1] + ways[2] * g[3];
    let d1 = changes[1] * g[0] + changes[2] * g[2];
    let d2 = changes[1] * g[1] + changes[2] * g[3];
    let normal = normal_of(cross(f1, f2), bend.crushed);
    let dm = cross(d1, f2 + d2) + cross(f1, d2);
    let dm_size = length(d1) * length(f2 + d2) + length(f1) * length(d2);
    let trial = normal_of(normal.m + dm, bend.crushed);
    // scale = k / q with q^2 = m^2 + crushed^2; its change is -k dq / (q q') = -scale dq / q'.
    let q = sqrt(normal.squared);
    let q_trial = sqrt(trial.squared);
    let dq = dot(dm, 2.0 * normal.m + dm) / (q + q_trial);
    let dn = dm * trial.scale - normal.m * (normal.scale * dq / q_trial);
    let n = normal.m * normal.scale;
    var factors = factors_of(bend);
    var means: array<vec3<f32>, 3>;
    var residuals: array<vec3<f32>, 3>;
    var turns: array<vec3<f32>, 3>;
    var sizes: vec3<f32>;
    var turn_sizes: vec3<f32>;
    for (var i = 0u; i < 3u; i += 1u) {
        let c = bend.rest[3u * i + 2u];
        var r = n * -c;
        var dr = dn * -c;
        var r_size = abs(c);
        var dr_size = 2.0 * abs(c) * dm_size * trial.scale;
        for (var p = 1u; p < 6u; p += 1u) {
            let factor = factors[6u * i + p];
            r += ways[p] * factor;
            dr += changes[p] * factor;
            r_size += length(ways[p]) * abs(factor);
            dr_size += length(changes[p]) * abs(factor);
        }
        residuals[i] = r;
        turns[i] = dr;
        means[i] = r + 0.5 * dr;
        sizes[i] = r_size + 0.5 * dr_size;
        turn_sizes[i] = dr_size;
    }
    var out = vec3<f32>(0.0);
    for (var i = 0u; i < 3u; i += 1u) {
        for (var k = 0u; k < 3u; k += 1u) {
            let value = bend.gram[3u * i + k];
            out += vec3<f32>(
                0.5 * value * dot(residuals[i], residuals[k]),
                value * dot(turns[i], means[k]),
                abs(value) * turn_sizes[i] * sizes[k],
            );
        }
    }
    return part(out);
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var sum = vec4<f32>(0.0);
    for (var e = THREADS * group.x + local.x; e < params.count; e += THREADS * params.workgroups) {
        sum += energy(bends[e]);
    }
    put_part(group.x, local.x, sum);
}
