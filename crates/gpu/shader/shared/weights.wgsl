// The vertices of a pair with their weights in its gap.

struct Pair {
    kind: u32,
    // Vertices of the pair, and how many of them are on side a.
    count: u32,
    side_a: u32,
    vertices: array<u32, 4>,
}

// A pair of that kind, of which the vertices are known.
fn pair_with(kind: u32, v: vec4<u32>) -> Pair {
    let vertices = array<u32, 4>(v.x, v.y, v.z, v.w);
    switch kind {
        case VERTEX_VERTEX: {
            return Pair(kind, 2u, 1u, vertices);
        }
        case VERTEX_EDGE: {
            return Pair(kind, 3u, 1u, vertices);
        }
        case VERTEX_TRIANGLE: {
            return Pair(kind, 4u, 1u, vertices);
        }
        case EDGE_EDGE: {
            return Pair(kind, 4u, 2u, vertices);
        }
        default: {
            return Pair(kind, 1u, 1u, vertices);
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
