// Second part of the places in a list: where those of each block begin, and how many there are. One workgroup.

struct Params {
    blocks: u32,
    // Entries that the list holds.
    capacity: u32,
    // As in count.wgsl.
    list: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(2) var<storage, read_write> control: Control;

var<workgroup> shared_skips: u32;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    if local.x == 0u {
        shared_skips = u32(params.list == 0u && atomicLoad(&control.changed) == 0u);
    }
    if workgroupUniformLoad(&shared_skips) != 0u {
        return;
    }
    var total = 0u;
    for (var first = 0u; first < params.blocks; first += 256u) {
        let block = first + local.x;
        var count = 0u;
        if block < params.blocks {
            count = blocks[block];
        }
        let before = sum_before(local.x, count);
        if block < params.blocks {
            blocks[block] = saturating_sum(total, before);
        }
        total = saturating_sum(total, sums[255]);
        workgroupBarrier();
    }
    if local.x == 0u {
        if params.list == 0u {
            atomicStore(&control.candidates, total);
        } else {
            atomicStore(&control.rows, total);
        }
        if total > params.capacity {
            atomicStore(&control.overflow, 1u);
        }
    }
}
