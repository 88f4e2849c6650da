// What the kernels of strands share: see assembly/layout.rs. The energy of an element is k/2 (|w| - w0)^2
// with w = c (x2 - x1) - a (x1 - x0); of an edge, whose nodes 0 and 1 are the same, a is 0.

struct Strand {
    nodes: array<u32, 3>,
    rest: f32,
    inverse_lengths: array<f32, 2>,
    stiffness: f32,
    damping: f32,
}

// The second derivative by w: across I + axial along along^T.
struct Curvature {
    along: array<f32, 3>,
    axial: f32,
    across: f32,
}

fn is_edge(strand: Strand) -> bool {
    return strand.nodes[0] == strand.nodes[1];
}

// w, or a change of it, of the ways (or their changes) from node 0 to node 1 and from node 1 to node 2.
fn jump_of(strand: Strand, first: vec3<f32>, second: vec3<f32>) -> vec3<f32> {
    return second * strand.inverse_lengths[1] - first * strand.inverse_lengths[0];
}

// The unit vector along w, of that length.
fn along_of(strand: Strand, w: vec3<f32>, size: f32) -> vec3<f32> {
    if size > 0.0 {
        return w / size;
    }
    return vec3<f32>(select(0.0, 1.0, is_edge(strand)), 0.0, 0.0);
}

// The weights of w by node.
fn weights_of(strand: Strand) -> vec3<f32> {
    let a = strand.inverse_lengths[0];
    let c = strand.inverse_lengths[1];
    return vec3<f32>(a, -(a + c), c);
}
