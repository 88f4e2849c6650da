//! Sums over the threads of a workgroup and over partial sums: twin of `shader/shared/sum.wgsl`.

/// Threads of a workgroup.
pub const THREADS: usize = 256;

/// Most workgroups that write partial sums: the workgroups of the next stage each add them all, one per thread.
pub const MOST_WORKGROUPS: usize = 256;

/// The sum of a number of each thread.
pub fn sum_of_threads(mut values: [f32; THREADS]) -> f32 {
    let mut reach = THREADS / 2;
    while reach > 0 {
        for t in 0..reach {
            values[t] += values[t + reach];
        }
        reach /= 2;
    }
    values[0]
}

/// The sum of partial sums.
pub fn sum_of_parts(parts: &[f32]) -> f32 {
    sum_of_threads(std::array::from_fn(|t| {
        parts.iter().skip(t).step_by(THREADS).fold(0.0, |sum, part| sum + part)
    }))
}
