//! What runs recordings: a device ([`DeviceEngine`]), or the twins of its kernels on the CPU ([`TwinEngine`]).

mod compare;
mod device;
mod pipelines;
mod profile;
mod traits;
mod twin;

pub use compare::{ComparingEngine, Difference};
pub use device::DeviceEngine;
pub use profile::{Profile, StageTime};
pub use traits::Engine;
pub use twin::TwinEngine;
