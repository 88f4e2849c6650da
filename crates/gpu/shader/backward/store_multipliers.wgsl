// Parts: types.
//
// Stores the multipliers of the rows with their candidates.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
@group(0) @binding(2) var<storage, read_write> states: array<PairState>;
@group(0) @binding(3) var<storage, read_write> control: Control;

var<workgroup> shared_pressing: atomic<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    var pressing = 0u;
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        states[rows[r].candidate].multiplier = rows[r].multiplier;
        pressing += u32(rows[r].multiplier > 0.0);
        states[rows[r].candidate].friction = rows[r].friction;
    }
    // One sum per workgroup: additions to one word wait for each other.
    if pressing > 0u {
        atomicAdd(&shared_pressing, pressing);
    }
    workgroupBarrier();
    if local.x == 0u && atomicLoad(&shared_pressing) > 0u {
        atomicAdd(&control.pressing, atomicLoad(&shared_pressing));
    }
}
