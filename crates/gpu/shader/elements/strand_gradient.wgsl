// Parts: elements, gradients, strand.
//
// Gradients of strands: the crate bowknot-dynamics, elements/strand.rs.

@group(0) @binding(1) var<storage, read> strands: array<Strand>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        let strand = strands[e];
        let n = strand.nodes;
        let w = jump_of(strand, way(n[0], n[1]), way(n[1], n[2]));
        let size = length(w);
        var force = along_of(strand, w, size) * (size - strand.rest);
        if strand.damping > 0.0 && params.rate > 0.0 {
            let factor = strand.damping * params.rate;
            let turned = jump_of(strand, moved(n[0], n[1]), moved(n[1], n[2]));
            if is_edge(strand) {
                force += w * (0.5 * factor * dot(turned, 2.0 * w - turned));
            } else {
                force += turned * factor;
            }
        }
        force *= strand.stiffness;
        let weights = weights_of(strand);
        put(3u * e, force * weights.x);
        put(3u * e + 1u, force * weights.y);
        put(3u * e + 2u, force * weights.z);
    }
}
