// Third part of the places in a list: where each row of the search, or each candidate, begins in the list, and where the
// last one ends.

struct Params {
    rows: u32,
    // As in count.wgsl.
    list: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> blocks: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if params.list == 0u && atomicLoad(&control.changed) == 0u {
        return;
    }
    for (var row = id.x; row < params.rows; row += 256u * MOST_WORKGROUPS) {
        starts[row] = saturating_sum(starts[row], blocks[row / 256u]);
    }
    if id.x == 0u {
        if params.list == 0u {
            starts[params.rows] = atomicLoad(&control.candidates);
        } else {
            starts[params.rows] = atomicLoad(&control.rows);
        }
    }
}
