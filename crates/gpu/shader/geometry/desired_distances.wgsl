// Parts: types, closest, weights, pair.
//
// Desired distance and minimum separation of candidates that are new or come into range, and the minimum
// separation of all for the forward step.
//
// The desired distance of two elements of one connected component is at most half of their rest distance:
// otherwise it would tear a fine mesh apart. A pair that starts closer opens by at most `growth` in a call.
// Where the target knows the contacts of a vertex, pairs that are near guard only a part of their gap: the
// target decides about the rest.

struct Params {
    capacity: u32,
    // 1: nothing is to be done unless a search has changed the candidates.
    after_search: u32,
    // Minimum separation of bodies without a thickness.
    min_separation: f32,
    growth: f32,
    // Distance within which a pair can have a row, in desired distances.
    range: f32,
    // The half-spaces lie behind the vertices.
    first_half_space: u32,
    // Distance in the desired one below which the target knows a contact, share of its gap that is then
    // guarded, and the smallest distance asked for, in the way from the minimum separation to the desired
    // distance.
    known: f32,
    guarded: f32,
    guarded_floor: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Positions in the rest shape, and the connected component.
@group(0) @binding(1) var<storage, read> rest: array<vec4<i32>>;
@group(0) @binding(2) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(6) var<storage, read_write> separations: array<Separation>;
@group(0) @binding(7) var<storage, read_write> states: array<PairState>;
@group(0) @binding(8) var<storage, read_write> control: Control;

// A minimum separation that is no guarantee is at most this part of the desired distance.
const MIN_SEPARATION_SHARE: f32 = 0.1;
// Smallest ratio of a desired distance to a guaranteed minimum separation.
const MIN_SEPARATION_MARGIN: f32 = 1.5;

fn rest_distance(pair: Pair) -> f32 {
    let p = rest[pair.vertices[0]].xyz;
    let a = vec3<f32>(rest[pair.vertices[1]].xyz - p);
    var offset = a;
    if pair.kind == VERTEX_EDGE {
        offset = closest_vertex_edge(a, vec3<f32>(rest[pair.vertices[2]].xyz - p)).offset;
    } else if pair.kind != VERTEX_VERTEX {
        let b = vec3<f32>(rest[pair.vertices[2]].xyz - p);
        let c = vec3<f32>(rest[pair.vertices[3]].xyz - p);
        if pair.kind == EDGE_EDGE {
            offset = closest_edge_edge(a, b, c).offset;
        } else {
            offset = closest_vertex_triangle(a, b, c).offset;
        }
    }
    return sqrt(dot(offset, offset));
}

// Flags of any vertex of a pair.
fn flags_of(pair: Pair) -> u32 {
    let v = pair.vertices;
    return vertices[v[0]].flags | vertices[v[1]].flags | vertices[v[2]].flags | vertices[v[3]].flags;
}

fn first_state(candidate: Candidate, separation: Separation) -> PairState {
    let pair = pair_of(candidate);
    let a = vertices[pair.vertices[0]];
    var delta = a.half_space_delta;
    var range = params.range * delta;
    var thickness = -1.0;
    if pair.kind == VERTEX_HALF_SPACE {
        let b = vertices[params.first_half_space + candidate.b];
        if b.thickness >= 0.0 {
            delta = max(delta, 0.5 * (a.delta + MIN_SEPARATION_MARGIN * b.thickness));
            range = params.range * delta;
        }
        if max(a.thickness, b.thickness) >= 0.0 {
            let of_a = select(params.min_separation, a.thickness, a.thickness >= 0.0);
            thickness = 0.5 * (of_a + max(b.thickness, 0.0));
        }
    } else {
        let b = vertices[pair.vertices[pair.side_a]];
        delta = 0.5 * (a.delta + b.delta);
        if max(a.thickness, b.thickness) >= 0.0 {
            let of_a = select(params.min_separation, a.thickness, a.thickness >= 0.0);
            let of_b = select(params.min_separation, b.thickness, b.thickness >= 0.0);
            thickness = 0.5 * (of_a + of_b);
        }
        range = params.range * delta;
        if rest[pair.vertices[0]].w == rest[pair.vertices[pair.side_a]].w {
            delta = min(delta, 0.5 * rest_distance(pair));
        }
    }
    let distance = max(separation.distance, 0.0);
    var desired = min(delta, distance + params.growth);
    var least = min(params.min_separation, MIN_SEPARATION_SHARE * desired);
    if thickness >= 0.0 {
        least = min(min(thickness, delta / MIN_SEPARATION_MARGIN), max(separation.width, 0.0));
    }
    let known = flags_of(pair) & KNOWN;
    if known != 0u && distance < params.known * delta {
        let lowest = least + params.guarded_floor * (delta - least);
        desired = min(desired, max(params.guarded * distance, lowest));
    }
    return PairState(vec3<f32>(0.0), 0.0, desired, least, range, 0u);
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if params.after_search != 0u && atomicLoad(&control.changed) == 0u {
        return;
    }
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        let is_new = states[c].desired < 0.0;
        if is_new || (states[c].is_far != 0u && separations[c].distance <= states[c].range) {
            // What the pair carries at the start of the call stays (warm_start.wgsl).
            let first = first_state(candidates[c], separations[c]);
            states[c].desired = first.desired;
            states[c].min_separation = first.min_separation;
            states[c].range = first.range;
        }
        states[c].is_far = u32(separations[c].distance > states[c].range);
        separations[c].min_separation = states[c].min_separation;
        separations[c].wanted = states[c].desired;
    }
}
