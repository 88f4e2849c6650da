// The pair of a candidate. A stage that uses it has `edges` and `triangles` among its bindings.

fn pair_of(candidate: Candidate) -> Pair {
    let kind = candidate.kind_and_a >> ELEMENT_BITS;
    let a = candidate.kind_and_a & ELEMENT_MASK;
    let b = candidate.b;
    var vertices = vec4<u32>(a);
    switch kind {
        case VERTEX_VERTEX: {
            vertices.y = b;
        }
        case VERTEX_EDGE: {
            vertices = vec4<u32>(a, edges[b], a);
        }
        case VERTEX_TRIANGLE: {
            vertices = vec4<u32>(a, triangles[b].xyz);
        }
        case EDGE_EDGE: {
            vertices = vec4<u32>(edges[a], edges[b]);
        }
        default: {}
    }
    return pair_with(kind, vertices);
}
