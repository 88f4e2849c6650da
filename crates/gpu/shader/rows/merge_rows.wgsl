// Parts: types, weights, pair, contact.
//
// Takes the rows of pairs away whose contact has the row of another pair (hash_contacts.wgsl), which asks for
// at least as much. What has no row does not press. Contacts that share their place in the table with another
// one keep all their rows: that costs time and changes no solution, for the same row twice asks for what it
// asks for once.

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
@group(0) @binding(5) var<storage, read> table: array<u32>;
@group(0) @binding(6) var<storage, read_write> states: array<PairState>;
// 1 for a candidate that gets a row.
@group(0) @binding(7) var<storage, read_write> starts: array<u32>;
@group(0) @binding(8) var<storage, read_write> control: Control;

const NUMBER: u32 = 0x7fffffffu;

@compute @workgroup_size(128)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 128u * MOST_WORKGROUPS) {
        if starts[c] == 0u {
            continue;
        }
        let contact = contact_of(c);
        if !contact.is_shared {
            continue;
        }
        let other = table[place_of(contact, params.mask)] & NUMBER;
        if other == c || separations[other].wanted < separations[c].wanted {
            continue;
        }
        if all(contact_of(other).vertices == contact.vertices) {
            starts[c] = 0u;
            states[c].multiplier = 0.0;
            states[c].friction = vec3<f32>(0.0);
        }
    }
}
