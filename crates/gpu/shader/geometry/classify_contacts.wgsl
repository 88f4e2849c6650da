// Parts: types, weights, pair.
//
// Tells contacts from pairs that are only close, and sets the distance that the row of each pair asks for.
// Where two surfaces touch, many pairs are close, but the distance has a minimum at few of them; a row along
// the normal of another would block what slides past. A pair is a contact if its normal lies in the normal
// cones of the features that its closest points are on: no neighbor of a feature is nearer to the other side.
// A pair that is close but no contact guards only a part of its gap.

struct Params {
    capacity: u32,
    // Where the lists of `adjacency` begin: the triangles at the edges, and the edges of the triangles.
    edges_first: u32,
    triangles_first: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> positions: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> triangles: array<vec4<u32>>;
// For each vertex, then for each edge, where its list of vertices begins; these lists; three edges of each
// triangle.
@group(0) @binding(4) var<storage, read> adjacency: array<u32>;
@group(0) @binding(5) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(6) var<storage, read> states: array<PairState>;
@group(0) @binding(7) var<storage, read_write> separations: array<Separation>;
@group(0) @binding(8) var<storage, read_write> control: Control;

const VERTEX: u32 = 0u;
const EDGE: u32 = 1u;
const FACE: u32 = 2u;

const OUTSIDE: u32 = 0u;
const INSIDE: u32 = 1u;
// The cone is one direction and its opposite.
const FLAT: u32 = 2u;

// A closest point is on the border of its primitive if a weight is at most this.
const ON_BORDER: f32 = 1e-6;
// Sines: by how much a normal may leave its cone, and up to where two faces are one flat surface.
const CONE_TOLERANCE: f32 = 0.02;
const FLAT_TOLERANCE: f32 = 2e-3;
// A pair that is closer than this share of its desired distance has a row whatever its normal, for this share
// of its gap and at least this share of the desired distance.
const CLOSE: f32 = 1.001;
const SHARE: f32 = 0.9;
const LEAST_SHARE: f32 = 0.5;

struct Feature {
    kind: u32,
    index: u32,
}

fn on_edge(edge: u32, vertices: vec2<u32>, last: f32) -> Feature {
    if 1.0 - last <= ON_BORDER {
        return Feature(VERTEX, vertices.y);
    }
    if last <= ON_BORDER {
        return Feature(VERTEX, vertices.x);
    }
    return Feature(EDGE, edge);
}

fn on_triangle(triangle: u32, vertices: vec3<u32>, weights: vec3<f32>) -> Feature {
    let inside = weights > vec3<f32>(ON_BORDER);
    let first_edge = params.triangles_first + 3u * triangle;
    if all(inside) {
        return Feature(FACE, triangle);
    }
    // The edges are in the order 0-1, 1-2, 2-0 of the vertices.
    if inside.x && inside.y {
        return Feature(EDGE, adjacency[first_edge]);
    }
    if inside.y && inside.z {
        return Feature(EDGE, adjacency[first_edge + 1u]);
    }
    if inside.x && inside.z {
        return Feature(EDGE, adjacency[first_edge + 2u]);
    }
    return Feature(VERTEX, select(select(vertices.z, vertices.y, inside.y), vertices.x, inside.x));
}

// Where a direction lies relative to the normal cone of a feature.
fn place(feature: Feature, outward: vec3<f32>) -> u32 {
    if feature.kind == FACE {
        return INSIDE;
    }
    var entry = feature.index;
    var origin = vec3<i32>(0);
    var along = vec3<f32>(0.0);
    if feature.kind == EDGE {
        entry += params.edges_first;
        let edge = edges[feature.index];
        origin = positions[edge.x].xyz;
        let whole = vec3<f32>(positions[edge.y].xyz - origin);
        along = whole / max(sqrt(dot(whole, whole)), 1.0);
    } else {
        origin = positions[feature.index].xyz;
    }
    let start = adjacency[entry];
    let end = adjacency[entry + 1u];
    var flat = feature.kind == EDGE && end > start + 1u;
    for (var k = start; k < end; k += 1u) {
        var to = vec3<f32>(positions[adjacency[k]].xyz - origin);
        to -= along * dot(along, to);
        let size = sqrt(dot(to, to));
        let rise = dot(outward, to);
        if rise > CONE_TOLERANCE * size {
            return OUTSIDE;
        }
        flat = flat && rise >= -FLAT_TOLERANCE * size;
    }
    return select(INSIDE, FLAT, flat);
}

fn is_contact(pair: Pair, candidate: Candidate, separation: Separation) -> bool {
    let v = pair.vertices;
    let weights = separation.weights;
    var a = Feature(VERTEX, v[0]);
    var b = Feature(VERTEX, v[1]);
    switch pair.kind {
        case VERTEX_EDGE: {
            b = on_edge(candidate.b, vec2<u32>(v[1], v[2]), weights.x);
        }
        case VERTEX_TRIANGLE: {
            let all_weights = vec3<f32>(1.0 - weights.x - weights.y, weights);
            b = on_triangle(candidate.b, vec3<u32>(v[1], v[2], v[3]), all_weights);
        }
        case EDGE_EDGE: {
            a = on_edge(candidate.kind_and_a & ELEMENT_MASK, vec2<u32>(v[0], v[1]), weights.x);
            b = on_edge(candidate.b, vec2<u32>(v[2], v[3]), weights.y);
        }
        case VERTEX_HALF_SPACE: {
            b = Feature(FACE, 0u);
        }
        default: {}
    }
    // A vertex above a face always is a contact.
    if a.kind == VERTEX && b.kind == FACE {
        return true;
    }
    let first = place(a, -separation.normal);
    if first == OUTSIDE {
        return false;
    }
    let second = place(b, separation.normal);
    // Vertices and faces represent two edges within flat surfaces completely.
    let both_flat = first == FLAT && second == FLAT && a.kind == EDGE && b.kind == EDGE;
    return second != OUTSIDE && !both_flat;
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        let separation = separations[c];
        let state = states[c];
        if separation.distance > state.range || is_contact(pair_of(candidates[c]), candidates[c], separation) {
            continue;
        }
        var wanted = 0.0;
        if separation.distance < CLOSE * state.desired || state.multiplier > 0.0 {
            wanted = clamp(SHARE * separation.distance, LEAST_SHARE * state.desired, state.desired);
        }
        separations[c].wanted = wanted;
    }
}
