//! What runs recordings: a device ([`DeviceEngine`]), or the twins of its kernels on the CPU ([`TwinEngine`]).

mod bindings;
mod compare;
mod compiled;
mod device;
mod opened;
mod phases;
mod profile;
mod traits;
mod twin;

pub use compare::{ComparingEngine, Difference};
pub use device::DeviceEngine;
pub use phases::PhaseSeconds;
pub use profile::{Profile, StageTime};
pub use traits::Engine;
pub use twin::TwinEngine;
