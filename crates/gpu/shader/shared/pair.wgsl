// The vertices of a pair. A stage that uses it has `edges` and `triangles` among its bindings.

struct Pair {
    kind: u32,
    // Vertices of the pair, and how many of them are on side a.
    count: u32,
    side_a: u32,
    vertices: array<u32, 4>,
}

fn pair_of(candidate: Candidate) -> Pair {
    let kind = candidate.kind_and_a >> ELEMENT_BITS;
    let a = candidate.kind_and_a & ELEMENT_MASK;
    let b = candidate.b;
    switch kind {
        case VERTEX_VERTEX: {
            return Pair(kind, 2u, 1u, array<u32, 4>(a, b, a, a));
        }
        case VERTEX_EDGE: {
            let edge = edges[b];
            return Pair(kind, 3u, 1u, array<u32, 4>(a, edge.x, edge.y, a));
        }
        case VERTEX_TRIANGLE: {
            let triangle = triangles[b];
            return Pair(kind, 4u, 1u, array<u32, 4>(a, triangle.x, triangle.y, triangle.z));
        }
        case EDGE_EDGE: {
            let first = edges[a];
            let second = edges[b];
            return Pair(kind, 4u, 2u, array<u32, 4>(first.x, first.y, second.x, second.y));
        }
        default: {
            return Pair(kind, 1u, 1u, array<u32, 4>(a, a, a, a));
        }
    }
}

// Weights of the vertices in the gap: + on side a, - on side b.
fn signed_weights(pair: Pair, separation: Separation) -> vec4<f32> {
    let s = separation.weights.x;
    let t = separation.weights.y;
    switch pair.kind {
        case VERTEX_VERTEX: {
            return vec4<f32>(1.0, -1.0, 0.0, 0.0);
        }
        case VERTEX_EDGE: {
            // The weight of the last vertex is the first of the two; that of the other is what is left.
            return vec4<f32>(1.0, s - 1.0, -s, 0.0);
        }
        case VERTEX_TRIANGLE: {
            return vec4<f32>(1.0, s + t - 1.0, -s, -t);
        }
        case EDGE_EDGE: {
            return vec4<f32>(1.0 - s, s, t - 1.0, -t);
        }
        default: {
            return vec4<f32>(1.0, 0.0, 0.0, 0.0);
        }
    }
}
