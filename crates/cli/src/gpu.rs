//! What the command does on a GPU: the devices, and `resolve --backend gpu`.

use crate::args::Machine;
use crate::exit::Failure;
use bowknot::geometry::Point;
use bowknot::recording::States;
use bowknot::twoway::{Resolver, Statistics};

/// The devices, one per line, with what those that cannot be used lack.
#[cfg(feature = "gpu")]
pub fn list() -> Result<String, Failure> {
    use bowknot::gpu::Adapter;
    let adapters = Adapter::all();
    if adapters.is_empty() {
        // The error tells what was looked for.
        Adapter::choose(None).map_err(Failure::backend)?;
    }
    let line = |(number, adapter): (usize, &Adapter)| match adapter.lacks() {
        None => format!("{number}: {adapter}\n"),
        Some(what) => format!("{number}: {adapter}: cannot be used, it has no {what}\n"),
    };
    Ok(adapters.iter().enumerate().map(line).collect())
}

/// Solves a problem on the device that `machine` names. `go_on` is asked after each step.
#[cfg(feature = "gpu")]
pub fn resolve(
    machine: &Machine,
    resolver: &Resolver,
    x: &mut [Point],
    states: &States,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Statistics, Failure> {
    use bowknot::gpu::{Adapter, DeviceEngine, GpuResolveError, resolve_on};
    let adapter = Adapter::choose(machine.device).map_err(Failure::backend)?;
    if adapter.is_software() {
        eprintln!("warning: {adapter} computes on the CPU: slower than --backend cpu");
    }
    let engine = DeviceEngine::open(&adapter).map_err(Failure::backend)?;
    let solved = resolve_on(engine, resolver.scene(), x, &states.y, &states.input(), go_on);
    solved.map_err(|error| match error {
        GpuResolveError::Input(error) => Failure::input(error),
        error => Failure::backend(error),
    })
}

#[cfg(not(feature = "gpu"))]
pub fn list() -> Result<String, Failure> {
    Err(not_built_in())
}

#[cfg(not(feature = "gpu"))]
pub fn resolve(
    _machine: &Machine,
    _resolver: &Resolver,
    _x: &mut [Point],
    _states: &States,
    _go_on: &mut dyn FnMut() -> bool,
) -> Result<Statistics, Failure> {
    Err(not_built_in())
}

#[cfg(not(feature = "gpu"))]
fn not_built_in() -> Failure {
    Failure::backend(
        "this bowknot was built without the feature `gpu`: build it with it, or use --backend cpu",
    )
}
