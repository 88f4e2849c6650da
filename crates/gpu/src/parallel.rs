//! Loops over the vertices of a scene on the threads of the host.

use rayon::prelude::*;

/// Entries that one task computes.
const CHUNK: usize = 4096;

/// What `of` makes of each entry, in parallel if there are many: a parallel loop pays for the way to its
/// threads.
pub fn collected<T: Sync, R: Send>(entries: &[T], of: impl Fn(&T) -> R + Send + Sync) -> Vec<R> {
    match entries.len() {
        ..=CHUNK => entries.iter().map(of).collect(),
        _ => entries.par_iter().with_min_len(CHUNK).map(of).collect(),
    }
}

/// What `of` makes of each number below `count`, in parallel if there are many.
pub fn collected_numbers<R: Send>(count: usize, of: impl Fn(usize) -> R + Send + Sync) -> Vec<R> {
    match count {
        ..=CHUNK => (0..count).map(of).collect(),
        _ => (0..count).into_par_iter().with_min_len(CHUNK).map(of).collect(),
    }
}

/// What `join` makes of all that `of` makes of the entries, and of `start`, in any order and `start` any
/// number of times.
pub fn folded<T: Sync, R: Copy + Send + Sync>(
    entries: &[T],
    start: R,
    of: impl Fn(&T) -> R + Send + Sync,
    join: impl Fn(R, R) -> R + Send + Sync,
) -> R {
    let of_chunk = |chunk: &[T]| chunk.iter().map(&of).fold(start, &join);
    match entries.len() {
        ..=CHUNK => of_chunk(entries),
        _ => entries.par_chunks(CHUNK).map(of_chunk).reduce(|| start, &join),
    }
}

/// The largest of what `of` makes of each entry, and 0; what is not a number is left out.
pub fn largest<T: Sync>(entries: &[T], of: impl Fn(&T) -> f64 + Send + Sync) -> f64 {
    folded(entries, 0.0, of, f64::max)
}

/// Whether all entries pass a test.
pub fn all<T: Sync>(entries: &[T], test: impl Fn(&T) -> bool + Send + Sync) -> bool {
    folded(entries, true, test, |a, b| a & b)
}
