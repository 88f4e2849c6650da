//! Collisions on a GPU: scenes as the CPU knows them, solved by `bowknot-gpu`.
//!
//! The device takes the same two-way steps and stops by the same rule. Its sweeps make no coarse corrections, so that it may
//! take other steps than the CPU. Positions lie on a grid, see [`bowknot_gpu::Grid`].
//!
//! [`Device`] is a [backend](crate::simulator::CollisionBackend) of simulations, whose dynamics stay on the CPU;
//! [`resolve_on`] solves a single problem.

mod device;
mod error;
mod setup;

pub use bowknot_gpu::{Adapter, ComparingEngine, DeviceEngine, GpuError, Profile, StageTime, TwinEngine};
pub use device::{Device, resolve_on};
pub use error::GpuResolveError;
