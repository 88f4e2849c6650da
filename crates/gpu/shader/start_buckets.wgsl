// Where the rows of each bucket begin and end in their order: sums of the numbers of rows. One workgroup.

struct Params {
    buckets: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> tally: array<u32>;
@group(0) @binding(2) var<storage, read_write> buckets: array<Bucket>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    var total = 0u;
    for (var first = 0u; first < params.buckets; first += 256u) {
        let bucket = first + local.x;
        var count = 0u;
        if bucket < params.buckets {
            count = tally[bucket];
        }
        let start = total + sum_before(local.x, count);
        if bucket < params.buckets {
            buckets[bucket] = Bucket(start, start + count, 0u);
        }
        total += sums[255];
        workgroupBarrier();
    }
}
