// Parts: types, scan, entries.
//
// Third part of a prefix sum: where each row of the search, or each candidate, begins in the list, and where
// the last one ends.

struct Params {
    // Most rows.
    rows: u32,
    // See entries.wgsl.
    list: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let rows = rows_of(params.list, params.rows);
    for (var row = id.x; row < rows; row += 256u * MOST_WORKGROUPS) {
        starts[row] = saturating_sum(starts[row], blocks[row / 256u]);
    }
    if id.x > 0u {
        return;
    }
    if params.list == CONTACT_ROWS {
        starts[rows] = atomicLoad(&control.rows);
    } else if rows > 0u {
        starts[rows] = atomicLoad(&control.candidates);
    }
}
