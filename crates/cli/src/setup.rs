//! Logging, threads and the choice of a backend.

use crate::args::{Backend, Machine};
use crate::exit::Failure;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Shows the warnings of the libraries on stderr, or their errors only if `quiet`. The variable `BOWKNOT_LOG`
/// selects other levels, such as `debug`, also by crate: `warn,bowknot_twoway=debug`.
pub fn logging(quiet: bool) {
    let default = Targets::new().with_default(if quiet { LevelFilter::ERROR } else { LevelFilter::WARN });
    let asked = std::env::var("BOWKNOT_LOG").ok().filter(|levels| !levels.is_empty());
    let filter = asked.and_then(|levels| levels.parse().ok()).unwrap_or(default);
    let messages =
        tracing_subscriber::fmt::layer().with_writer(std::io::stderr).without_time().with_target(false);
    tracing_subscriber::registry().with(messages).with(filter).init();
}

/// Starts the threads, and refuses a backend that is not built in.
pub fn machine(machine: &Machine) -> Result<(), Failure> {
    if machine.backend == Backend::Gpu {
        return Err(no_gpu());
    }
    let threads = machine.threads.unwrap_or(0);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::input(format!("cannot start {threads} threads: {error}; try fewer")))
}

/// The failure of a command that asks for a GPU.
pub fn no_gpu() -> Failure {
    Failure::backend("no GPU backend is built in yet: use --backend cpu or leave the option out")
}
