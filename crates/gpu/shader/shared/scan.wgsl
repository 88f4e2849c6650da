// Sums over the 256 threads of a workgroup. They saturate: a sum that wraps could be less than what a list
// holds, and what is missing from the list would not be noticed.

var<workgroup> sums: array<u32, 256>;

fn saturating_sum(a: u32, b: u32) -> u32 {
    return a + min(b, 0xffffffffu - a);
}

// The sum of the counts of the threads before this one; afterwards `sums[255]` holds that of all. All threads
// call it, and wait before they call it again.
fn sum_before(thread: u32, count: u32) -> u32 {
    sums[thread] = count;
    workgroupBarrier();
    for (var reach = 1u; reach < 256u; reach *= 2u) {
        var before = 0u;
        if thread >= reach {
            before = sums[thread - reach];
        }
        workgroupBarrier();
        sums[thread] = saturating_sum(before, sums[thread]);
        workgroupBarrier();
    }
    return select(0u, sums[max(thread, 1u) - 1u], thread > 0u);
}
