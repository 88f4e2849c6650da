// Parts: elements, blocks, strand.
//
// Hessians of strands: the crate bowknot-dynamics, elements/strand.rs. What multiplies search directions is
// the second derivative by w (strand_product.wgsl); blocks are for the preconditioner.

@group(0) @binding(1) var<storage, read> strands: array<Strand>;
@group(0) @binding(5) var<storage, read_write> curvatures: array<Curvature>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var e = id.x; e < params.elements; e += 64u * MOST_WORKGROUPS) {
        let strand = strands[e];
        let n = strand.nodes;
        let w = jump_of(strand, way(n[0], n[1]), way(n[1], n[2]));
        let size = length(w);
        let along = along_of(strand, w, size);
        var axial = 1.0;
        var across = 1.0;
        if strand.rest > 0.0 {
            across = 1.0 - strand.rest / max(size, MIN_RATIO * strand.rest);
        }
        if strand.damping > 0.0 && params.rate > 0.0 {
            let factor = strand.damping * params.rate;
            if is_edge(strand) {
                let turned = jump_of(strand, moved(n[0], n[1]), moved(n[1], n[2]));
                let strain = 0.5 * factor * dot(turned, 2.0 * w - turned);
                axial += factor * size * size + strain;
                across += strain;
            } else {
                axial += factor;
                across += factor;
            }
        }
        axial = strand.stiffness * filtered(axial);
        across = strand.stiffness * filtered(across);
        curvatures[e] = Curvature(array<f32, 3>(along.x, along.y, along.z), axial - across, across);
        let weights = weights_of(strand);
        var block = 3u * e;
        for (var a = 0u; a < 3u; a += 1u) {
            for (var b = a + 1u; b < 3u; b += 1u) {
                let weight = weights[a] * weights[b];
                let across_block = weight * across;
                let shift = along * (weight * (axial - across));
                put(
                    block,
                    shift * along.x + vec3<f32>(across_block, 0.0, 0.0),
                    shift * along.y + vec3<f32>(0.0, across_block, 0.0),
                    shift * along.z + vec3<f32>(0.0, 0.0, across_block),
                );
                block += 1u;
            }
        }
    }
}
