// Sums over the 256 threads of a workgroup.

var<workgroup> sums: array<u32, 256>;

// The sum of the counts of the threads up to this one; afterwards `sums[255]` holds that of all. All threads call it, and
// wait before they call it again.
fn sum_up_to(thread: u32, count: u32) -> u32 {
    sums[thread] = count;
    workgroupBarrier();
    for (var reach = 1u; reach < 256u; reach *= 2u) {
        var before = 0u;
        if thread >= reach {
            before = sums[thread - reach];
        }
        workgroupBarrier();
        sums[thread] += before;
        workgroupBarrier();
    }
    return sums[thread];
}
