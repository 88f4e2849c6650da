// First part of the places in a list, of candidates or of contact rows: where those of each row of the search, or of each
// candidate, begin within a block of 256. Counts become sums in place.

struct Params {
    rows: u32,
    // 0: the list of candidates, which is as it was unless a search changes it; 1: that of contact rows.
    list: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> starts: array<u32>;
@group(0) @binding(2) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(3) var<storage, read_write> control: Control;

var<workgroup> shared_skips: u32;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_skips = u32(params.list == 0u && atomicLoad(&control.changed) == 0u);
    }
    if workgroupUniformLoad(&shared_skips) != 0u {
        return;
    }
    for (var block = group.x; 256u * block < params.rows; block += MOST_WORKGROUPS) {
        let row = 256u * block + local.x;
        var count = 0u;
        if row < params.rows {
            count = starts[row];
        }
        let before = sum_before(local.x, count);
        if row < params.rows {
            starts[row] = before;
        }
        if local.x == 255u {
            blocks[block] = sums[255];
        }
        workgroupBarrier();
    }
}
