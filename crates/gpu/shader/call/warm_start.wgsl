// Parts: types.
//
// After the first search of a call: gives candidates the multipliers that their pairs carry at its start.

struct Params {
    capacity: u32,
    // Entries of the list, sorted by pair.
    carried: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> carried: array<CarriedState>;
@group(0) @binding(2) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(3) var<storage, read_write> states: array<PairState>;
@group(0) @binding(4) var<storage, read_write> control: Control;

// Sides of one kind in the order of their numbers, as in the list.
fn ordered(candidate: Candidate) -> Candidate {
    let kind = candidate.kind_and_a >> ELEMENT_BITS;
    let a = candidate.kind_and_a & ELEMENT_MASK;
    if (kind == VERTEX_VERTEX || kind == EDGE_EDGE) && candidate.b < a {
        return Candidate((kind << ELEMENT_BITS) | candidate.b, a);
    }
    return candidate;
}

// The place of a pair in the list; NONE if it carries nothing.
fn place_of(pair: Candidate) -> u32 {
    var low = 0u;
    var high = params.carried;
    while low < high {
        let middle = (low + high) / 2u;
        let found = carried[middle].candidate;
        if found.kind_and_a == pair.kind_and_a && found.b == pair.b {
            return middle;
        }
        if found.kind_and_a < pair.kind_and_a || (found.kind_and_a == pair.kind_and_a && found.b < pair.b) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return NONE;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 256u * MOST_WORKGROUPS) {
        let pair = ordered(candidates[c]);
        let place = place_of(pair);
        if place == NONE {
            continue;
        }
        // Friction is that on side a.
        let swapped = pair.kind_and_a != candidates[c].kind_and_a;
        let friction = carried[place].friction;
        states[c].friction = select(friction, -friction, swapped);
        states[c].multiplier = carried[place].multiplier;
    }
}
