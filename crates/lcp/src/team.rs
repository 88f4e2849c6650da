//! Several threads through one sequence of phases, each phase in parallel, with no fork between them.
//!
//! A sweep has dozens of colours of a few hundred rows, ten microseconds of work each; forking and
//! joining anew for each would cost as much. So one fork covers all sweeps: each thread walks the
//! same sequence of phases (colours), claims chunks by a counter and waits, spinning, until all
//! chunks of the earlier phases are done. A chunk is only ever claimed by a thread that is running,
//! and the earliest unfinished one never waits, so no thread waits in vain: if no other thread ever
//! comes to help, the first does everything. Which thread runs a chunk has no influence on results.

use std::sync::atomic::{AtomicUsize, Ordering};

/// A sequence of phases. Within a phase any places may run at the same time.
pub(crate) trait Phases: Sync {
    /// How many phases there are.
    fn count(&self) -> usize;
    /// How many places a phase has, and how many make a chunk (at least 1).
    fn size(&self, phase: usize) -> (usize, usize);
    /// Runs places `begin..end` of a phase; returns a number of which the largest is kept a thread.
    fn run(&self, phase: usize, begin: usize, end: usize, residual: &mut f64);
}

#[derive(Default)]
struct Progress {
    /// Chunks claimed, over all phases.
    claimed: AtomicUsize,
    /// Chunks done; since no chunk begins before the earlier phases are done, it tells which are.
    done: AtomicUsize,
}

/// Runs all phases on up to `threads` threads of the current pool; returns the largest residual.
pub(crate) fn run(phases: &impl Phases, threads: usize) -> f64 {
    fork(threads, &|progress| work(phases, progress), &Progress::default())
}

fn fork(threads: usize, task: &(impl Fn(&Progress) -> f64 + Sync), progress: &Progress) -> f64 {
    if threads <= 1 {
        return task(progress);
    }
    let half = threads / 2;
    let (a, b) = rayon::join(|| fork(half, task, progress), || fork(threads - half, task, progress));
    a.max(b)
}

fn work(phases: &impl Phases, progress: &Progress) -> f64 {
    let mut residual = 0.0;
    let mut claim = progress.claimed.fetch_add(1, Ordering::Relaxed);
    // Chunks of the phases before this one.
    let mut before = 0;
    for phase in 0..phases.count() {
        let (size, chunk) = phases.size(phase);
        let chunks = size.div_ceil(chunk);
        while claim < before + chunks {
            wait(|| progress.done.load(Ordering::Acquire) >= before);
            let begin = (claim - before) * chunk;
            phases.run(phase, begin, size.min(begin + chunk), &mut residual);
            progress.done.fetch_add(1, Ordering::Release);
            claim = progress.claimed.fetch_add(1, Ordering::Relaxed);
        }
        before += chunks;
    }
    residual
}

/// Spins until `ready`; yields once that takes long, as when there are more threads than cores.
fn wait(ready: impl Fn() -> bool) {
    let mut spins = 0_u32;
    while !ready() {
        spins += 1;
        if spins < 256 { std::hint::spin_loop() } else { std::thread::yield_now() }
    }
}
