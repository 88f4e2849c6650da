use super::*;
use std::sync::Mutex;

/// Records, for each place, when it was run, and checks that earlier phases are done.
struct Recorder {
    sizes: Vec<(usize, usize)>,
    runs: Vec<Vec<AtomicUsize>>,
    chunks: Mutex<Vec<(usize, usize)>>,
}

impl Recorder {
    fn new(sizes: Vec<(usize, usize)>) -> Self {
        let runs = sizes.iter().map(|&(size, _)| (0..size).map(|_| AtomicUsize::new(0)).collect()).collect();
        Self { sizes, runs, chunks: Mutex::default() }
    }
}

impl Phases for Recorder {
    fn count(&self) -> usize {
        self.sizes.len()
    }
    fn size(&self, phase: usize) -> (usize, usize) {
        self.sizes[phase]
    }
    fn run(&self, phase: usize, places: Range<usize>, residual: &mut f64) {
        for earlier in &self.runs[..phase] {
            assert!(earlier.iter().all(|run| run.load(Ordering::Relaxed) == 1), "phase {phase} began early");
        }
        self.chunks.lock().expect("no panic yet").push((phase, places.len()));
        for place in places {
            self.runs[phase][place].fetch_add(1, Ordering::Relaxed);
            *residual = residual.max((phase * 1000 + place) as f64);
        }
    }
}

#[test]
fn every_place_runs_once_and_phases_in_order_on_any_number_of_threads() {
    let sizes = vec![(100, 7), (0, 5), (3, 5), (64, 64), (65, 64), (1, 1), (200, 1), (90, 16)];
    for threads in [1, 2, 3, 8, 40] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.min(8)).build().expect("a pool");
        for _ in 0..20 {
            let recorder = Recorder::new(sizes.clone());
            assert_eq!(pool.install(|| run(&recorder, threads)), 7089.0);
            assert!(recorder.runs.iter().flatten().all(|run| run.load(Ordering::Relaxed) == 1));
            let chunks = recorder.chunks.into_inner().expect("no panic");
            for (phase, size) in chunks {
                assert!(size > 0 && size <= sizes[phase].1);
            }
        }
    }
}

#[test]
fn one_thread_alone_runs_the_shares_of_all() {
    // The pool has one thread, so no other thread takes a share.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let recorder = Recorder::new(vec![(1000, 10), (500, 10)]);
    assert_eq!(pool.install(|| run(&recorder, 16)), 1499.0);
}
