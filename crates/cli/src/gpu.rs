//! What the command does on a GPU: the devices, and the backends of `run` and `resolve`.

use crate::args::{Backend, Machine};
use crate::exit::Failure;
use bowknot::simulator::{CollisionBackend, Cpu};

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

/// What resolves collisions on the machine that the options name.
pub fn backend(machine: &Machine) -> Result<Box<dyn CollisionBackend>, Failure> {
    match machine.backend {
        Backend::Gpu => device(machine),
        Backend::Cpu | Backend::Auto => Ok(Box::new(Cpu)),
    }
}

#[cfg(feature = "gpu")]
fn device(machine: &Machine) -> Result<Box<dyn CollisionBackend>, Failure> {
    use bowknot::gpu::{Adapter, Device, DeviceEngine};
    let adapter = Adapter::choose(machine.device).map_err(Failure::backend)?;
    if adapter.is_software() {
        eprintln!("warning: {adapter} computes on the CPU: slower than --backend cpu");
    }
    let engine = DeviceEngine::open(&adapter).map_err(Failure::backend)?;
    Ok(Box::new(Device::new(format!("gpu: {adapter}"), engine)))
}

#[cfg(not(feature = "gpu"))]
pub fn list() -> Result<String, Failure> {
    Err(not_built_in())
}

#[cfg(not(feature = "gpu"))]
fn device(_machine: &Machine) -> Result<Box<dyn CollisionBackend>, Failure> {
    Err(not_built_in())
}

#[cfg(not(feature = "gpu"))]
fn not_built_in() -> Failure {
    Failure::backend(
        "this bowknot was built without the feature `gpu`: build it with it, or use --backend cpu",
    )
}
