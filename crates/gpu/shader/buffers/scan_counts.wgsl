// Parts: types, scan, entries.
//
// First part of a prefix sum, of the numbers of candidates or of contact rows: where those of each row of the
// search, or of each candidate, begin within a block of 256. Counts become sums in place.

struct Params {
    // Most rows.
    rows: u32,
    // See entries.wgsl.
    list: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(3) var<storage, read_write> control: Control;

var<workgroup> shared_rows: u32;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_rows = rows_of(params.list, params.rows);
    }
    let rows = workgroupUniformLoad(&shared_rows);
    for (var block = group.x; 256u * block < rows; block += MOST_WORKGROUPS) {
        let row = 256u * block + local.x;
        var count = 0u;
        if row < rows {
            count = starts[row];
        }
        let before = sum_before(local.x, count);
        if row < rows {
            starts[row] = before;
        }
        if local.x == 255u {
            blocks[block] = sums[255];
        }
        workgroupBarrier();
    }
}
