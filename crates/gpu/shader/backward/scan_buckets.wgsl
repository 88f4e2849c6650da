// Parts: types, scan.
//
// Where the rows of each bucket begin and end in their order: sums of the numbers of rows. One workgroup:
// each thread has buckets that follow each other.

struct Params {
    buckets: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> tally: array<u32>;
@group(0) @binding(2) var<storage, read_write> buckets: array<Bucket>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_id) local: vec3<u32>) {
    let share = (params.buckets + 255u) / 256u;
    let first = min(share * local.x, params.buckets);
    let last = min(first + share, params.buckets);
    var own = 0u;
    for (var bucket = first; bucket < last; bucket += 1u) {
        own += tally[bucket];
    }
    var start = sum_before(local.x, own);
    for (var bucket = first; bucket < last; bucket += 1u) {
        let end = start + tally[bucket];
        buckets[bucket] = Bucket(start, end, 0u, 0u);
        start = end;
    }
}
