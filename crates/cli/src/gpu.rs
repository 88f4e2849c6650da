//! What the command does on a GPU: the devices, and the backends of `run` and `resolve`.

use crate::args::{Backend, LinearBackend, Machine, RunOptions};
use crate::exit::Failure;
use bowknot::run::Backends;
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
        None => {
            let most = adapter.largest_buffer() / (1 << 20);
            format!("{number}: {adapter}, buffers of {most} MiB at most\n")
        }
        Some(what) => format!("{number}: {adapter}: cannot be used, it has no {what}\n"),
    };
    Ok(adapters.iter().enumerate().map(line).collect())
}

/// What resolves collisions on the machine that the options name.
pub fn backend(machine: &Machine) -> Result<Box<dyn CollisionBackend>, Failure> {
    match machine.backend {
        Backend::Gpu => device::collisions(machine.device),
        Backend::Cpu | Backend::Auto => Ok(Box::new(Cpu)),
    }
}

/// What computes a run with these options.
pub fn backends(options: &RunOptions) -> Result<Backends, Failure> {
    let linear = match options.linear_backend {
        LinearBackend::Gpu => Some(device::linear_solves(options.machine.device)?),
        LinearBackend::Cpu => None,
    };
    Ok(Backends { collisions: backend(&options.machine)?, linear })
}

/// The backends on a device.
#[cfg(feature = "gpu")]
mod device {
    use super::{CollisionBackend, Failure};
    use bowknot::dynamics::LinearBackend;
    use bowknot::gpu::{Adapter, ConjugateGradients, Device, DeviceEngine};

    pub fn collisions(number: Option<usize>) -> Result<Box<dyn CollisionBackend>, Failure> {
        let (name, engine) = open(number, "--backend cpu")?;
        Ok(Box::new(Device::new(name, engine)))
    }

    pub fn linear_solves(number: Option<usize>) -> Result<Box<dyn LinearBackend>, Failure> {
        let (name, engine) = open(number, "--linear-backend cpu")?;
        Ok(Box::new(ConjugateGradients::new(name, engine)))
    }

    /// Opens the device of that number, or the first, for one backend: each has its own queue and buffers.
    fn open(number: Option<usize>, without: &str) -> Result<(String, DeviceEngine), Failure> {
        let adapter = Adapter::choose(number).map_err(Failure::backend)?;
        if adapter.is_software() {
            eprintln!("warning: {adapter} computes on the CPU: slower than {without}");
        }
        let engine = DeviceEngine::open(&adapter).map_err(Failure::backend)?;
        Ok((format!("gpu: {adapter}"), engine))
    }
}

/// What takes the place of the devices in a build without them.
#[cfg(not(feature = "gpu"))]
mod device {
    use super::{CollisionBackend, Failure, not_built_in};
    use bowknot::dynamics::LinearBackend;

    pub fn collisions(_number: Option<usize>) -> Result<Box<dyn CollisionBackend>, Failure> {
        Err(not_built_in())
    }

    pub fn linear_solves(_number: Option<usize>) -> Result<Box<dyn LinearBackend>, Failure> {
        Err(not_built_in())
    }
}

#[cfg(not(feature = "gpu"))]
pub fn list() -> Result<String, Failure> {
    Err(not_built_in())
}

#[cfg(not(feature = "gpu"))]
fn not_built_in() -> Failure {
    Failure::backend(
        "this bowknot was built without the feature `gpu`: build it with it, or use --backend cpu and --linear-backend cpu",
    )
}
