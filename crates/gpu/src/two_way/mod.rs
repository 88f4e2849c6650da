//! Scenes of `bowknot-twoway` on an engine: a processor of the two-way loop, which makes several steps per
//! submission.
//!
//! Positions lie on a [grid](crate::Grid). Sweeps go through rows and edges in another order than on the CPU,
//! so that it may take other steps. What the kernels do not have is refused.

mod device;
mod error;
mod flight;
mod judge;
mod pairs;
mod setup;

pub use device::{Device, resolve_on};
pub use error::GpuResolveError;
