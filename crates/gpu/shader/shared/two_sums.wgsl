// Two sums over partial sums at once, each in the order of sum.wgsl: threads wait for each other half as
// often.

var<workgroup> shared_pairs: array<vec2<f32>, THREADS>;

fn two_sums_of_parts(thread: u32, firsts: vec2<u32>, counts: vec2<u32>) -> vec2<f32> {
    let a = sum_of_own_parts(thread, firsts.x, counts.x);
    shared_pairs[thread] = vec2<f32>(a, sum_of_own_parts(thread, firsts.y, counts.y));
    for (var reach = THREADS / 2u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if thread < reach {
            shared_pairs[thread] += shared_pairs[thread + reach];
        }
    }
    return workgroupUniformLoad(&shared_pairs[0]);
}
