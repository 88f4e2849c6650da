// Parts: elements, parts, energies, strand.
//
// Energies of strands: the crate bowknot-dynamics, elements/strand.rs. From the change of w follows that of
// its length, without cancellation.

@group(0) @binding(1) var<storage, read> strands: array<Strand>;

// The energy at the reference, its change, and its size.
fn energy(strand: Strand) -> vec4<f32> {
    let n = strand.nodes;
    let first = way(n[0], n[1]);
    let second = way(n[1], n[2]);
    let first_change = change(n[0], n[1]);
    let second_change = change(n[1], n[2]);
    let w = jump_of(strand, first, second);
    let dw = jump_of(strand, first_change, second_change);
    let size = length(w);
    let both = size + length(w + dw);
    var dq = 0.0;
    if both > 0.0 {
        dq = dot(dw, 2.0 * w + dw) / both;
    }
    // Of a turn, w is a difference of two tangents: its rounding is that of them.
    let a = strand.inverse_lengths[0];
    let c = strand.inverse_lengths[1];
    let moves = c * length(second_change) + a * length(first_change);
    let reach = c * length(second) + a * length(first) + moves;
    let strain = size - strand.rest;
    // An edge that turns hardly changes its length: its rounding is that of the change, and of the strain
    // where it changes.
    var changed = moves;
    if is_edge(strand) {
        changed = abs(dq);
    }
    let error = changed * (reach + strand.rest) + moves * (abs(strain) + abs(dq));
    var out = vec3<f32>(0.5 * strain * strain, dq * (strain + 0.5 * dq), error);
    if strand.damping > 0.0 && params.rate > 0.0 {
        let factor = strand.damping * params.rate;
        let turned = jump_of(strand, moved(n[0], n[1]), moved(n[1], n[2]));
        if is_edge(strand) {
            let before = 0.5 * dot(turned, 2.0 * w - turned);
            let de = 0.5 * dot(dw, 2.0 * w + dw);
            let de_size = moves * reach;
            let before_size = length(turned) * (reach + 0.5 * length(turned));
            out += factor * vec3<f32>(0.5 * before * before, de * (before + 0.5 * de), de_size * (before_size + de_size));
        } else {
            let sizes = c * length(moved(n[1], n[2])) + a * length(moved(n[0], n[1]));
            out += factor * vec3<f32>(0.5 * dot(turned, turned), dot(dw, turned + 0.5 * dw), moves * (sizes + moves));
        }
    }
    return part(out * strand.stiffness);
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    var sum = vec4<f32>(0.0);
    for (var e = THREADS * group.x + local.x; e < params.count; e += THREADS * params.workgroups) {
        sum += energy(strands[e]);
    }
    put_part(group.x, local.x, sum);
}
