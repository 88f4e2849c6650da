// Parts: types.
//
// The candidates that are within contact range, in the order of the candidates, as many as there is room for.

struct Params {
    // Candidates, and pairs for which there is room.
    capacity: u32,
    near_capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Where each candidate is in the list, if it is: then that of the next comes after it.
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(3) var<storage, read_write> near: array<Candidate>;
@group(0) @binding(4) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.candidates), params.capacity);
    for (var c = id.x; c < count; c += 256u * MOST_WORKGROUPS) {
        let place = starts[c];
        if starts[c + 1u] > place && place < params.near_capacity {
            near[place] = candidates[c];
        }
    }
}
