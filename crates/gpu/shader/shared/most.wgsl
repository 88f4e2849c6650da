// The largest of WORDS numbers of each of the 256 threads of a workgroup. One atomic operation per workgroup
// follows in place of one per thread: those on one address wait for each other. A maximum is the same in any
// order.

var<workgroup> most: array<u32, 256 * WORDS>;

// Afterwards `most[256 k]` holds the largest of number k. All threads call it once.
fn find_most(thread: u32, own: array<u32, WORDS>) {
    for (var k = 0u; k < WORDS; k += 1u) {
        most[256u * k + thread] = own[k];
    }
    for (var reach = 128u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if thread < reach {
            for (var k = 0u; k < WORDS; k += 1u) {
                let at = 256u * k + thread;
                most[at] = max(most[at], most[at + reach]);
            }
        }
    }
    workgroupBarrier();
}
