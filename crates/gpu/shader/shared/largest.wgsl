// The largest of a number of each thread, and of partial results in `sums`: the same in any order. Numbers
// are not negative.

var<workgroup> shared_largest: array<f32, THREADS>;

fn largest_of_threads(thread: u32, value: f32) -> f32 {
    workgroupBarrier();
    shared_largest[thread] = value;
    for (var reach = THREADS / 2u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if thread < reach {
            shared_largest[thread] = max(shared_largest[thread], shared_largest[thread + reach]);
        }
    }
    return workgroupUniformLoad(&shared_largest[0]);
}

// The largest of `count` numbers from `first` on, each `stride` after the one before.
fn largest_of_parts(thread: u32, first: u32, count: u32, stride: u32) -> f32 {
    var largest = 0.0;
    for (var k = thread; k < count; k += THREADS) {
        largest = max(largest, sums[first + stride * k]);
    }
    return largest_of_threads(thread, largest);
}
