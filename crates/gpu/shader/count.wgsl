// First part of the list of candidates: where those of each row begin within a block of 256 rows.

struct Params {
    rows: u32,
    stride: u32,
    most: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> partners: array<u32>;
@group(0) @binding(2) var<storage, read_write> starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(4) var<storage, read_write> control: Control;

var<workgroup> sums: array<u32, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
    @builtin(workgroup_id) block: vec3<u32>,
) {
    let row = id.x;
    var count = 0u;
    if row < params.rows {
        let found = partners[row * params.stride];
        count = min(found, params.most);
        if atomicLoad(&control.changed) != 0u {
            atomicMax(&control.most_partners, found);
            if found > params.most {
                atomicStore(&control.overflow, 1u);
            }
        }
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
