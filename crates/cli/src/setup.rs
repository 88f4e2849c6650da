//! Logging, threads and the choice of a backend.

use crate::args::{Backend, DynamicsBackend, Machine};
use crate::exit::Failure;
use bowknot_errors::counted;
use std::io::IsTerminal;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Shows the warnings of the libraries on stderr, or their errors only if `quiet`. The variable `BOWKNOT_LOG`
/// selects other levels, such as `debug`, also by crate: `warn,bowknot_twoway=debug`.
pub fn logging(quiet: bool) {
    let default = Targets::new().with_default(if quiet { LevelFilter::ERROR } else { LevelFilter::WARN });
    let asked = std::env::var("BOWKNOT_LOG").ok().filter(|levels| !levels.is_empty());
    let filter = asked.and_then(|levels| levels.parse().ok()).unwrap_or(default);
    let messages = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(colors())
        .without_time()
        .with_target(false);
    tracing_subscriber::registry().with(messages).with(filter).init();
}

/// Whether stderr may have color codes: on a terminal only, and not if the variable `NO_COLOR` holds anything
/// (<https://no-color.org>).
fn colors() -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    std::io::stderr().is_terminal() && !refused
}

/// Keeps a layer of Mesa's Vulkan drivers silent where no display can be found. To list the GPU of the
/// display first, the layer connects to Wayland on each listing of the GPUs. Without `XDG_RUNTIME_DIR`, as in
/// a container, libwayland then prints an error; pictures are drawn all the same. The layer stays on if the
/// user selects a GPU through it.
///
/// To be called while the process has one thread.
#[cfg(all(any(feature = "gpu", feature = "render"), target_os = "linux"))]
pub fn no_display() {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if set("XDG_RUNTIME_DIR") || set("MESA_VK_DEVICE_SELECT") {
        return;
    }
    // SAFETY: no other thread can read the environment at the same time, since there is none yet.
    #[allow(unsafe_code)]
    unsafe {
        std::env::set_var("NODEVICE_SELECT", "1");
    }
}

/// Refuses a device that nothing is computed on.
pub fn refuse_idle_device(machine: &Machine, dynamics: Option<DynamicsBackend>) -> Result<(), Failure> {
    let is_used = matches!(machine.backend, Some(Backend::Gpu | Backend::Auto))
        || dynamics == Some(DynamicsBackend::Gpu);
    if machine.device.is_some() && !is_used {
        return Err(Failure::input(
            "--device needs --backend gpu or auto, or --dynamics-backend gpu of `run`",
        ));
    }
    Ok(())
}

/// Stack of each thread [bytes]: that of a main thread.
const STACK: usize = 8 << 20;

/// Starts the threads.
pub fn machine(machine: &Machine) -> Result<(), Failure> {
    let threads = machine.threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
    pool.build_global().map_err(|error| {
        Failure::input(format!("cannot start {}: {error}; try fewer", counted(threads, "thread", "threads")))
    })
}
