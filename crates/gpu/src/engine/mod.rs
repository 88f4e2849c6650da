//! What runs recordings: a device ([`DeviceEngine`]), or, with the feature `twins`, the twins of
//! its kernels on the CPU ([`TwinEngine`]).

mod bindings;
#[cfg(feature = "twins")]
mod compare;
mod compiled;
mod device;
mod opened;
mod phases;
mod profile;
mod traits;
#[cfg(feature = "twins")]
mod twin;

#[cfg(feature = "twins")]
pub use compare::{ComparingEngine, Difference};
pub use device::DeviceEngine;
pub use phases::PhaseSeconds;
pub use profile::{Profile, StageTime};
pub use traits::Engine;
#[cfg(feature = "twins")]
pub use twin::TwinEngine;
