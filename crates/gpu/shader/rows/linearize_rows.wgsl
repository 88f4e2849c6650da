// Parts: types, weights, fixed.
//
// Contact rows, linearized at the positions, and the curvature of those that press: lambda |weight| / radius.

struct Params {
    capacity: u32,
    // Part of the curvature that counts.
    strength: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(2) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(3) var<storage, read> separations: array<Separation>;
@group(0) @binding(4) var<storage, read> states: array<PairState>;
// With the vertices and the candidate of each (compact_rows.wgsl).
@group(0) @binding(5) var<storage, read_write> rows: array<Row>;
@group(0) @binding(6) var<storage, read_write> proximal: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> control: Control;

// A closest point is at a vertex if the other weights of its side are at most this.
const AT_VERTEX: f32 = 1e-5;

fn inside(weight: f32) -> u32 {
    return u32(abs(weight) > AT_VERTEX);
}

// Radius of curvature of a contact, for a vertex with edges of that length: how far it moves while the normal
// turns by about one radian. A face does not turn, two edges that cross turn less the more they do, and
// things roll about edges and points.
fn radius_of(pair: Pair, weights: vec4<f32>, gap: f32, sine: f32, edge: f32) -> f32 {
    var inside_a = 1u;
    var inside_b = 1u;
    if pair.kind == VERTEX_HALF_SPACE {
        return edge;
    } else if pair.kind == EDGE_EDGE {
        inside_a = inside(weights.x) + inside(weights.y);
        inside_b = inside(weights.z) + inside(weights.w);
    } else if pair.kind != VERTEX_VERTEX {
        inside_b = inside(weights.y) + inside(weights.z) + inside(weights.w);
    }
    if inside_a == 2u && inside_b == 2u {
        return min(max(edge * sine, gap), edge);
    } else if inside_b == 3u {
        return edge;
    } else if inside_a == 2u || inside_b == 2u {
        return min(gap, edge);
    }
    return gap;
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 128u * MOST_WORKGROUPS) {
        let c = rows[r].candidate;
        let separation = separations[c];
        let state = states[c];
        let v = rows[r].vertices;
        let pair = pair_with(candidates[c].kind_and_a >> ELEMENT_BITS, v);
        let weights = signed_weights(pair, separation);
        if state.multiplier > 0.0 {
            let gap = max(max(separation.distance, state.desired), 1.0);
            for (var k = 0u; k < pair.count; k += 1u) {
                let radius = radius_of(pair, weights, gap, separation.sine, vertices[v[k]].edge);
                atomicAdd(&proximal[v[k]], weight_units(params.strength * state.multiplier * abs(weights[k]) / radius));
            }
        }
        rows[r] = Row(
            v, weights, separation.normal, separation.distance - separation.wanted, 0.0, state.multiplier, c, 0u,
            vec3<f32>(0.0), 0.0, vec3<f32>(0.0), 0u
        );
    }
}
