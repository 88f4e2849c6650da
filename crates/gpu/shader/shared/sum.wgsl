// Sums over the threads of a workgroup and over partial sums, in a fixed order.

const THREADS: u32 = 256u;

var<workgroup> shared_sums: array<f32, THREADS>;

// The sum of a number of each thread, known to all of them.
fn sum_of_threads(thread: u32, value: f32) -> f32 {
    workgroupBarrier();
    shared_sums[thread] = value;
    for (var reach = THREADS / 2u; reach > 0u; reach /= 2u) {
        workgroupBarrier();
        if thread < reach {
            shared_sums[thread] += shared_sums[thread + reach];
        }
    }
    return workgroupUniformLoad(&shared_sums[0]);
}

// The sum of the partial sums of a thread, of `count` from `first` on.
fn sum_of_own_parts(thread: u32, first: u32, count: u32) -> f32 {
    var sum = 0.0;
    for (var k = thread; k < count; k += THREADS) {
        sum += sums[first + k];
    }
    return sum;
}

// The sum of `count` partial sums from `first` on.
fn sum_of_parts(thread: u32, first: u32, count: u32) -> f32 {
    return sum_of_threads(thread, sum_of_own_parts(thread, first, count));
}
