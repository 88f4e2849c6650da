// Parts: types, weights, pair, contact.
//
// Finds who has the row of a contact. Many pairs have the same closest points where these are on vertices or
// edges; one row is enough. Each selected candidate enters its number at the place of its contact in a table,
// and the smallest stays there, of those that press if there are any. merge_rows.wgsl takes the rows of the
// others away.

struct Params {
    capacity: u32,
    // Size of the table less one.
    mask: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> edges: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(4) var<storage, read> separations: array<Separation>;
@group(0) @binding(5) var<storage, read> states: array<PairState>;
// 1 for a candidate that is selected.
@group(0) @binding(6) var<storage, read> starts: array<u32>;
@group(0) @binding(7) var<storage, read_write> table: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> control: Control;

// Candidates that do not press come after all that do.
const NOT_PRESSING: u32 = 0x80000000u;

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        if starts[c] == 0u {
            continue;
        }
        let contact = contact_of(c);
        if contact.is_shared {
            let number = select(c | NOT_PRESSING, c, states[c].multiplier > 0.0);
            atomicMin(&table[place_of(contact, params.mask)], number);
        }
    }
}
