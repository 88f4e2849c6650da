//! Several threads run one sequence of phases, each phase in parallel, without a fork between phases.
//!
//! A sweep has dozens of colors of a few hundred rows. One color is some microseconds of work, and a fork
//! and join would cost as much. So one fork covers all sweeps. Each thread goes through the same sequence of
//! phases (colors) and waits until all places of the earlier phases are done. Each thread has its
//! own share of every phase, the same fraction of the places: if rows are stored in spatial order, it
//! accesses the same nodes in every color, in its own cache. A thread that has finished its share takes
//! chunks of the shares of others.
//!
//! There is no deadlock. Only a running thread claims a chunk, and it runs the chunk at once; any thread may
//! claim a chunk that is not claimed yet. If no other thread ever runs, the first does everything. Results do
//! not depend on which thread runs a chunk.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// A sequence of phases. Within a phase any places may run at the same time.
pub(crate) trait Phases: Sync {
    /// How many phases there are.
    fn count(&self) -> usize;
    /// The number of places of a phase and of a chunk (at least 1). One thread runs a phase that is a single
    /// chunk.
    fn size(&self, phase: usize) -> (usize, usize);
    /// Runs places of a phase; raises `residual` to the largest residual among them.
    fn run(&self, phase: usize, places: Range<usize>, residual: &mut f64);
}

/// A color has no work for more threads than this.
const MAX_THREADS: usize = 32;

/// A counter that shares its cache lines with nothing else. Lines come in pairs of 64 bytes, because the
/// processor prefetches the neighbor.
#[derive(Default)]
#[repr(align(128))]
struct Counter(AtomicUsize);

#[derive(Default)]
struct Progress {
    /// Chunks claimed of each thread's shares, over all phases.
    claimed: [Counter; MAX_THREADS],
    /// Chunks done, over all shares and phases. No chunk begins before the earlier phases are done, so the
    /// count tells which phases are done.
    done: Counter,
}

/// Runs all phases on up to `threads` threads of the current pool; returns the largest residual.
pub(crate) fn run(phases: &impl Phases, threads: usize) -> f64 {
    let threads = threads.clamp(1, MAX_THREADS);
    let progress = Progress::default();
    fork(0..threads, &|own| work(phases, &progress, own, threads))
}

fn fork(own: Range<usize>, task: &(impl Fn(usize) -> f64 + Sync)) -> f64 {
    if own.len() <= 1 {
        return task(own.start);
    }
    let middle = own.start + own.len() / 2;
    let (a, b) = rayon::join(|| fork(own.start..middle, task), || fork(middle..own.end, task));
    a.max(b)
}

fn work(phases: &impl Phases, progress: &Progress, own: usize, threads: usize) -> f64 {
    let mut residual = 0.0;
    // Chunks of the phases before this one, of each share and of all.
    let mut before = [0; MAX_THREADS];
    let mut all_before = 0;
    for phase in 0..phases.count() {
        let (size, chunk) = phases.size(phase);
        // A phase that is one chunk belongs to the first share.
        let shares = if size <= chunk { 1 } else { threads };
        wait(|| progress.done.0.load(Ordering::Acquire) >= all_before);
        let mut all = 0;
        for turn in 0..shares {
            let share = (own + turn) % shares;
            let (start, end) = (size * share / shares, size * (share + 1) / shares);
            let chunks = (end - start).div_ceil(chunk);
            while let Some(claim) = claim(&progress.claimed[share].0, before[share] + chunks) {
                let begin = start + (claim - before[share]) * chunk;
                phases.run(phase, begin..end.min(begin + chunk), &mut residual);
                progress.done.0.fetch_add(1, Ordering::Release);
            }
            before[share] += chunks;
            all += chunks;
        }
        all_before += all;
    }
    residual
}

/// The next chunk of a share, unless its chunks up to `end` are all claimed.
fn claim(claimed: &AtomicUsize, end: usize) -> Option<usize> {
    let mut next = claimed.load(Ordering::Relaxed);
    while next < end {
        match claimed.compare_exchange_weak(next, next + 1, Ordering::Relaxed, Ordering::Relaxed) {
            Ok(_) => return Some(next),
            Err(seen) => next = seen,
        }
    }
    None
}

/// Waits until `ready`. It spins at first: usually another thread ends its chunk within a microsecond. If
/// that takes long, the system runs another program in place of that thread, or there are more threads than
/// cores. It then yields, and in the end sleeps, so that a waiting thread leaves its core to others.
fn wait(ready: impl Fn() -> bool) {
    let mut rounds = 0_u32;
    while !ready() {
        rounds += 1;
        if rounds < SPINS {
            std::hint::spin_loop();
        } else if rounds < SPINS + YIELDS {
            std::thread::yield_now();
        } else {
            std::thread::sleep(SLEEP);
        }
    }
}

/// Rounds of [`wait`] that spin: some microseconds.
const SPINS: u32 = 512;
/// Rounds that yield: some tens of microseconds.
const YIELDS: u32 = 32;
/// Length of a sleep. The system adds about as much; a time slice of another program takes milliseconds.
const SLEEP: Duration = Duration::from_micros(50);

#[cfg(test)]
mod tests;
