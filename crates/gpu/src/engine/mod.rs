//! What runs recordings: a device ([`DeviceEngine`]), or the twins of its kernels on the CPU ([`TwinEngine`]).

mod bisect;
mod device;
mod traits;
mod twin;

pub use bisect::BisectingEngine;
pub use device::DeviceEngine;
pub use traits::Engine;
pub use twin::TwinEngine;
