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
