//! Threads, logging and the choice of a backend.

use crate::args::{Backend, Machine};
use crate::failure::Failure;
use tracing_subscriber::EnvFilter;

/// Shows the libraries' warnings on stderr, unless `quiet`; `BOWKNOT_LOG=debug` shows more.
pub fn logging(quiet: bool) {
    let default = if quiet { "error" } else { "warn" };
    let filter = EnvFilter::try_from_env("BOWKNOT_LOG").unwrap_or_else(|_| EnvFilter::new(default));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .without_time()
        .with_target(false)
        .init();
}

/// Starts the threads and settles the backend. Returns its name.
pub fn machine(machine: &Machine) -> Result<&'static str, Failure> {
    if machine.backend == Backend::Gpu {
        return Err(no_gpu());
    }
    let threads = machine.threads.unwrap_or(0);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::input(format!("cannot start {threads} threads: {error}; try fewer")))?;
    Ok("cpu")
}

/// What to say where a GPU is asked for.
pub fn no_gpu() -> Failure {
    Failure::backend("no GPU backend is built in yet: use --backend cpu or leave the option out")
}
