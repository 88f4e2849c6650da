//! What runs recordings: a device ([`DeviceEngine`]), or the twins of its kernels on the CPU ([`TwinEngine`]).

mod compare;
mod device;
mod opened;
mod phases;
mod pipelines;
mod profile;
mod traits;
mod twin;

pub use compare::{ComparingEngine, Difference};
pub use device::DeviceEngine;
pub use phases::PhaseSeconds;
pub(crate) use pipelines::MOST_IMMEDIATES;
pub use profile::{Profile, StageTime};
pub use traits::Engine;
pub use twin::TwinEngine;
