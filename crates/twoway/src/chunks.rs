//! Loops over chunks of a fixed size, in parallel where there are several. Chunks do not depend on the number
//! of threads, and their results are joined in order, so results have the same bits for any number of
//! threads.

use rayon::prelude::*;
use std::ops::Range;

/// Vertices, edges or pairs of a chunk: some tens of microseconds of work, a few times what it takes to wake
/// a thread. Fewer are one chunk, which the calling thread runs.
const CHUNK: usize = 2048;

/// Results of chunks; their buffers are kept from call to call.
#[derive(Debug)]
pub(crate) struct Chunks<T> {
    results: Vec<Vec<T>>,
    used: usize,
}

impl<T> Default for Chunks<T> {
    fn default() -> Self {
        Self { results: Vec::new(), used: 0 }
    }
}

impl<T: Send> Chunks<T> {
    /// Calls `run` with each chunk of `0..count` and an empty list for its results.
    pub fn run(&mut self, count: usize, run: impl Fn(Range<usize>, &mut Vec<T>) + Sync) {
        self.used = count.div_ceil(CHUNK);
        if self.results.len() < self.used {
            self.results.resize_with(self.used, Vec::new);
        }
        let run_one = |chunk: usize, results: &mut Vec<T>| {
            results.clear();
            run(CHUNK * chunk..count.min(CHUNK * (chunk + 1)), results);
        };
        match &mut self.results[..self.used] {
            [] => {}
            [one] => run_one(0, one),
            many => many.par_iter_mut().enumerate().for_each(|(chunk, results)| run_one(chunk, results)),
        }
    }

    /// All results, in order.
    pub fn results(&self) -> impl Iterator<Item = &T> {
        self.results[..self.used].iter().flatten()
    }

    /// The sum of `of` over all chunks of `0..count`.
    pub fn sum(&mut self, count: usize, of: impl Fn(Range<usize>) -> T + Sync) -> T
    where
        T: std::iter::Sum<T> + Copy,
    {
        self.run(count, |range, results| results.push(of(range)));
        self.results().copied().sum()
    }
}

/// Calls `run` with each element of `values` and its index.
pub(crate) fn for_each<T: Send>(values: &mut [T], run: impl Fn(usize, &mut T) + Sync) {
    if values.len() <= CHUNK {
        values.iter_mut().enumerate().for_each(|(k, value)| run(k, value));
    } else {
        values.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, values)| {
            values.iter_mut().enumerate().for_each(|(k, value)| run(CHUNK * chunk + k, value));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_and_lists_have_the_same_bits_on_any_number_of_threads() {
        let value = |k: usize| (k as f64).sin();
        for count in [0, 1, CHUNK, CHUNK + 1, 5 * CHUNK + 17] {
            let on = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| {
                    let sum = Chunks::default().sum(count, |range| range.map(value).sum::<f64>());
                    let mut even = Chunks::default();
                    even.run(count, |range, list| list.extend(range.filter(|k| k % 2 == 0)));
                    let mut values = vec![0.0; count];
                    for_each(&mut values, |k, slot| *slot = value(k));
                    (sum.to_bits(), even.results().copied().collect::<Vec<usize>>(), values)
                })
            };
            let one = on(1);
            assert!(one.1.iter().copied().eq((0..count).step_by(2)));
            assert!(one.2.iter().enumerate().all(|(k, slot)| *slot == value(k)));
            for threads in [2, 3, 8] {
                assert!(on(threads) == one, "{threads} threads");
            }
        }
    }
}
