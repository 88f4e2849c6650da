// Parts: types.
//
// Before a search replaces the candidates: keeps them with their states, so that those that are found again
// inherit.

struct Params {
    rows: u32,
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(3) var<storage, read> states: array<PairState>;
@group(0) @binding(4) var<storage, read_write> old_rows: array<OldRow>;
@group(0) @binding(5) var<storage, read_write> old_elements: array<u32>;
@group(0) @binding(6) var<storage, read_write> old_states: array<PairState>;
@group(0) @binding(7) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    let total = min(atomicLoad(&control.candidates), params.capacity);
    for (var row = id.x; row < params.rows; row += 256u * MOST_WORKGROUPS) {
        let first = min(starts[row], total);
        let count = min(starts[row + 1u], total) - first;
        old_rows[row] = OldRow(first, count);
        for (var k = 0u; k < count; k += 1u) {
            old_elements[first + k] = candidates[first + k].b;
            old_states[first + k] = states[first + k];
        }
    }
}
