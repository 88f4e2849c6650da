//! Work on the thread pool, without the interpreter's lock, that Ctrl-C can end.

use crate::error;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// How often signals are looked at while work goes on.
const POLL: Duration = Duration::from_millis(30);

/// Stack of each thread [bytes]: that of a main thread, as the command has it.
const STACK: usize = 8 << 20;

/// The pool, and the process that it belongs to: threads do not survive a fork, as `multiprocessing` makes them.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// What came of some work.
pub struct Done<T> {
    /// The result, or the message of a panic.
    pub result: Result<T, String>,
    /// The exception of a signal that came meanwhile, such as `KeyboardInterrupt`.
    pub signal: Option<PyErr>,
}

impl<T> Done<T> {
    /// The result; a signal or a panic is an exception.
    pub fn finish(self) -> PyResult<T> {
        match (self.signal, self.result) {
            (Some(signal), _) => Err(signal),
            (None, result) => result.map_err(error::internal),
        }
    }
}

/// Runs `work` on a thread of the pool, with the interpreter's lock released. Its argument becomes true when a
/// signal handler of Python raises an exception, which only the main thread looks at: work should then end.
pub fn compute<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Arc<AtomicBool>) -> T + Send,
) -> PyResult<Done<T>> {
    let pool = pool()?;
    let stop = Arc::new(AtomicBool::new(false));
    let done = py.detach(|| {
        let (sender, receiver) = sync_channel(1);
        let mut signal = None;
        let result = pool.in_place_scope(|scope| {
            let stop_of_work = &stop;
            scope.spawn(move |_| {
                let result = panic::catch_unwind(AssertUnwindSafe(|| work(stop_of_work)));
                // The receiver outlives this scope.
                let _ = sender.send(result);
            });
            loop {
                match receiver.recv_timeout(POLL) {
                    Ok(result) => break result.map_err(|panic| message_of(panic.as_ref())),
                    Err(RecvTimeoutError::Timeout) if signal.is_none() => {
                        signal = Python::attach(|py| py.check_signals()).err();
                        stop.store(signal.is_some(), Ordering::Relaxed);
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => {
                        break Err("the work has ended without a result".to_owned());
                    }
                }
            }
        });
        Done { result, signal }
    });
    Ok(done)
}

/// Sets the number of threads; 0: one per core, or that of the variable `RAYON_NUM_THREADS`.
#[pyfunction]
pub fn set_threads(count: usize) -> PyResult<()> {
    let started = start(count)?;
    let mut pool = POOL.lock().map_err(error::internal)?;
    replace(&mut pool, started);
    Ok(())
}

/// Number of threads.
#[pyfunction]
pub fn threads() -> PyResult<usize> {
    Ok(pool()?.current_num_threads())
}

fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut pool = POOL.lock().map_err(error::internal)?;
    if let Some((process, pool)) = &*pool
        && *process == std::process::id()
    {
        return Ok(Arc::clone(pool));
    }
    let started = start(0)?;
    replace(&mut pool, Arc::clone(&started));
    Ok(started)
}

/// Puts a pool of this process in the place of another one.
fn replace(pool: &mut Option<(u32, Arc<ThreadPool>)>, started: Arc<ThreadPool>) {
    let process = std::process::id();
    let before = pool.replace((process, started));
    // The threads of a parent process are not here, so they cannot be told to end.
    if before.as_ref().is_some_and(|(own, _)| *own != process) {
        std::mem::forget(before);
    }
}

fn start(count: usize) -> PyResult<Arc<ThreadPool>> {
    let pool = ThreadPoolBuilder::new().num_threads(count).stack_size(STACK).build();
    pool.map(Arc::new).map_err(|error| error::input(format!("cannot start the threads: {error}; try fewer")))
}

fn message_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic without a message".to_owned())
}
