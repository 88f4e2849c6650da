// Parts: types, weights, pair.
//
// Which candidates get a contact row: those in range that press, or whose gap would be too small at the last
// aim. What gets no row does not press any more, and gives back its color.

struct Params {
    capacity: u32,
    // Gap below which a pair gets a row, in the distance that the row asks for.
    threshold: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> displacements: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(5) var<storage, read> separations: array<Separation>;
@group(0) @binding(6) var<storage, read_write> states: array<PairState>;
// 1 for a candidate that gets a row.
@group(0) @binding(7) var<storage, read_write> starts: array<u32>;
@group(0) @binding(8) var<storage, read_write> control: Control;

fn is_selected(c: u32) -> bool {
    let state = states[c];
    let separation = separations[c];
    if separation.distance > state.range || separation.wanted == 0.0 {
        return false;
    }
    if state.multiplier > 0.0 {
        return true;
    }
    let pair = pair_of(candidates[c]);
    let weights = signed_weights(pair, separation);
    var gap = separation.distance;
    for (var k = 0u; k < pair.count; k += 1u) {
        gap += weights[k] * dot(separation.normal, displacements[pair.vertices[k]].xyz);
    }
    return gap < params.threshold * separation.wanted;
}

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        let selected = is_selected(c);
        if !selected {
            states[c].multiplier = 0.0;
            states[c].friction = vec3<f32>(0.0);
        }
        starts[c] = u32(selected);
    }
}
