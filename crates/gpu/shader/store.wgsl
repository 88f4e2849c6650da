// Stores the multipliers of the rows with their candidates.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
@group(0) @binding(2) var<storage, read_write> states: array<PairState>;
@group(0) @binding(3) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        states[rows[r].candidate].multiplier = rows[r].multiplier;
        if rows[r].multiplier > 0.0 {
            atomicAdd(&control.pressing, 1u);
        }
        states[rows[r].candidate].friction = rows[r].friction;
    }
}
