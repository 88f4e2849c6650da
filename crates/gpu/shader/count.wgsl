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

var<workgroup> sums: array<u32, 256>;
var<workgroup> shared_skips: u32;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
    @builtin(workgroup_id) block: vec3<u32>,
) {
    let row = id.x;
    if local.x == 0u {
        shared_skips = u32(params.list == 0u && atomicLoad(&control.changed) == 0u);
    }
    if workgroupUniformLoad(&shared_skips) != 0u {
        return;
    }
    var count = 0u;
    if row < params.rows {
        count = starts[row];
    }
    sums[local.x] = count;
    workgroupBarrier();
    for (var reach = 1u; reach < 256u; reach *= 2u) {
        var before = 0u;
        if local.x >= reach {
            before = sums[local.x - reach];
        }
        workgroupBarrier();
        sums[local.x] += before;
        workgroupBarrier();
    }
    if row < params.rows {
        starts[row] = sums[local.x] - count;
    }
    if local.x == 255u {
        blocks[block.x] = sums[255];
    }
}
