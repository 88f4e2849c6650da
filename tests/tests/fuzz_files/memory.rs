//! An allocator that counts, and stops what would take all memory or never end.
// An allocator is unsafe by nature.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Bytes in use, by all threads.
static PRESENT: AtomicUsize = AtomicUsize::new(0);
/// The largest number of them since the watch began.
static PEAK: AtomicUsize = AtomicUsize::new(0);
/// A single allocation above it ends the process.
static LARGEST: AtomicUsize = AtomicUsize::new(usize::MAX);

pub static ALLOCATOR: Watch = Watch(Mutex::new(None));

/// The system's allocator, with counts.
pub struct Counting;

impl Counting {
    fn grow(size: usize) {
        if size > LARGEST.swap(usize::MAX, Ordering::Relaxed) {
            ALLOCATOR.give_up(&format!("one allocation of {size} bytes"));
        }
        let present = PRESENT.fetch_add(size, Ordering::Relaxed) + size;
        PEAK.fetch_max(present, Ordering::Relaxed);
    }
}

// SAFETY: all calls go to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::grow(layout.size());
        // SAFETY: as promised by the caller.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        PRESENT.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as promised by the caller.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// What is being tried.
struct Trial {
    input: Vec<u8>,
    start: usize,
    deadline: Instant,
}

/// Watches the memory and the time of one input.
pub struct Watch(Mutex<Option<Trial>>);

impl Watch {
    /// Begins. A single allocation above `largest` bytes, and more than this time, end the process: nothing
    /// else stops a reader that would take all memory or never return.
    pub fn watch(&'static self, input: &[u8], largest: usize, time: Duration) {
        static CLOCK: AtomicBool = AtomicBool::new(false);
        if !CLOCK.swap(true, Ordering::Relaxed) {
            thread::spawn(|| {
                loop {
                    thread::sleep(Duration::from_secs(1));
                    let trial = self.0.lock().ok();
                    let late = trial.and_then(|t| t.as_ref().map(|t| t.deadline < Instant::now()));
                    if late == Some(true) {
                        self.give_up("too much time");
                    }
                }
            });
        }
        let trial = Trial { input: input.to_vec(), start: 0, deadline: Instant::now() + time };
        if let Ok(mut present) = self.0.lock() {
            let start = PRESENT.load(Ordering::Relaxed);
            *present = Some(Trial { start, ..trial });
            PEAK.store(start, Ordering::Relaxed);
        }
        LARGEST.store(largest, Ordering::Relaxed);
    }

    /// Ends. Returns by how much the memory in use grew at most [bytes].
    pub fn unwatch(&self) -> usize {
        LARGEST.store(usize::MAX, Ordering::Relaxed);
        let trial = self.0.lock().ok().and_then(|mut trial| trial.take());
        trial.map_or(0, |trial| PEAK.load(Ordering::Relaxed).saturating_sub(trial.start))
    }

    fn give_up(&self, why: &str) -> ! {
        let trial = self.0.lock().ok();
        if let Some(trial) = trial.as_ref().and_then(|trial| trial.as_ref()) {
            let path = super::keep("fatal", &trial.input);
            eprintln!("{why} for an input of {} bytes: {}", trial.input.len(), path.display());
        }
        eprintln!("{}", std::backtrace::Backtrace::force_capture());
        std::process::abort();
    }
}
