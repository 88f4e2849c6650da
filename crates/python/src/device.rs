//! The GPU.

use crate::error;
use bowknot::Simulator;
use bowknot::dynamics::NewtonBackend;
use bowknot::gpu::{Adapter, ConjugateGradients, Device, DeviceEngine};
use pyo3::prelude::*;

/// The devices, one line each.
#[pyfunction]
pub fn gpus(py: Python<'_>) -> Vec<String> {
    let line = |adapter: &Adapter| match adapter.lacks() {
        None => adapter.to_string(),
        Some(what) => format!("{adapter}: cannot be used, it has no {what}"),
    };
    py.detach(|| Adapter::all().iter().map(line).collect())
}

/// Lets the CPU or a device compute a simulation.
pub fn set_backends(simulator: &mut Simulator, backend: &str, device: Option<usize>) -> PyResult<()> {
    match backend {
        "cpu" if device.is_some() => Err(error::input("device needs backend=\"gpu\"")),
        "cpu" => Ok(()),
        "gpu" => set_device(simulator, device),
        other => Err(error::input(format!("backend {other:?}: it must be \"cpu\" or \"gpu\""))),
    }
}

fn set_device(simulator: &mut Simulator, device: Option<usize>) -> PyResult<()> {
    let adapter = Adapter::choose(device).map_err(error::device)?;
    let engine = DeviceEngine::open(&adapter).map_err(error::device)?;
    let name = format!("gpu: {adapter}");
    let on_device = simulator.world().bodies_only_on_cpu().next().is_none();
    let dynamics = on_device.then(|| ConjugateGradients::new(name.clone(), engine.beside()));
    simulator.set_backend(Box::new(Device::new(name, engine))).map_err(error::simulation)?;
    let dynamics = dynamics.map(|dynamics| Box::new(dynamics) as Box<dyn NewtonBackend>);
    simulator.set_dynamics_backend(dynamics).map_err(error::simulation)
}
