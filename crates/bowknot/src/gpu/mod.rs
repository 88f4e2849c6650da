//! Simulation on a GPU: scenes as the CPU knows them, solved by `bowknot-gpu`.
//!
//! The device takes the same two-way steps and stops by the same rule. Its sweeps go through rows and edges in another
//! order, so that it may take other steps than the CPU. Positions lie on a grid, see [`bowknot_gpu::Grid`].
//!
//! [`Choice`] says whether a device is faster than the CPU in a scene.
//! [`Device`] is a [backend](crate::simulator::CollisionBackend) of simulations; [`resolve_on`] solves a single problem.
//! [`ConjugateGradients`] does the dynamics, which stay on the CPU otherwise
//! ([`Simulator::set_dynamics_backend`](crate::Simulator::set_dynamics_backend)).

mod backend;
mod choice;

pub use bowknot_gpu::{
    Adapter, BufferId, ConjugateGradients, Device, DeviceEngine, DispatchView, Engine, GpuError,
    GpuResolveError, Phase, Profile, Recording, StageTime, resolve_on,
};
#[cfg(feature = "twins")]
pub use bowknot_gpu::{ComparingEngine, TwinEngine};
pub use choice::Choice;
