// Parts: types, scan, entries.
//
// Second part of a prefix sum: where the entries of each block begin, and how many there are. One workgroup:
// each thread has blocks that follow each other, so there is one sum over the threads for any number of
// blocks.

struct Params {
    // Most blocks.
    blocks: u32,
    // Entries that the list holds.
    capacity: u32,
    // See entries.wgsl.
    list: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(2) var<storage, read_write> control: Control;

var<workgroup> shared_blocks: u32;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_blocks = min((rows_of(params.list, 256u * params.blocks) + 255u) / 256u, params.blocks);
    }
    let count = workgroupUniformLoad(&shared_blocks);
    if params.list == CANDIDATES && count == 0u {
        return;
    }
    let share = (count + 255u) / 256u;
    let first = min(share * local.x, count);
    let end = min(first + share, count);
    var own = 0u;
    for (var block = first; block < end; block += 1u) {
        own = saturating_sum(own, blocks[block]);
    }
    var start = sum_before(local.x, own);
    for (var block = first; block < end; block += 1u) {
        let entries = blocks[block];
        blocks[block] = start;
        start = saturating_sum(start, entries);
    }
    if local.x == 0u {
        let total = sums[255];
        if params.list == CANDIDATES {
            atomicStore(&control.candidates, total);
        } else {
            atomicStore(&control.rows, total);
        }
        if total > params.capacity {
            atomicStore(&control.overflow, 1u);
        }
    }
}
