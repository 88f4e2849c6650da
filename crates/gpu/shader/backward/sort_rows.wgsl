// Parts: types.
//
// Sorts the rows by bucket; their order within a bucket comes later. The numbers of rows count down to zero,
// from where the next step begins.

struct Params {
    capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Row>;
@group(0) @binding(2) var<storage, read> buckets: array<Bucket>;
@group(0) @binding(3) var<storage, read_write> tally: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> order: array<u32>;
@group(0) @binding(5) var<storage, read_write> control: Control;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = min(atomicLoad(&control.rows), params.capacity);
    for (var r = id.x; r < count; r += 256u * MOST_WORKGROUPS) {
        let bucket = rows[r].bucket;
        order[buckets[bucket].first + atomicSub(&tally[bucket], 1u) - 1u] = r;
    }
}
