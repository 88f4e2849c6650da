// Parts: types.
//
// After a search: gives each candidate the state that it had before, or that of a new one.

struct Params {
    rows: u32,
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> candidates: array<Candidate>;
@group(0) @binding(3) var<storage, read> old_rows: array<OldRow>;
@group(0) @binding(4) var<storage, read> old_elements: array<u32>;
@group(0) @binding(5) var<storage, read> old_states: array<PairState>;
@group(0) @binding(6) var<storage, read_write> states: array<PairState>;
@group(0) @binding(7) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var row = id.x; row < params.rows; row += 256u * MOST_WORKGROUPS) {
        let old = old_rows[row];
        for (var c = starts[row]; c < min(starts[row + 1u], params.capacity); c += 1u) {
            let element = candidates[c].b;
            var state = PairState(vec3<f32>(0.0), 0.0, -1.0, 0.0, 0.0, 0u);
            // Rows are short: 10 partners are many.
            for (var place = old.first; place < old.first + old.count; place += 1u) {
                if old_elements[place] == element {
                    state = old_states[place];
                    break;
                }
            }
            states[c] = state;
        }
    }
}
