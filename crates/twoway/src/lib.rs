//! The two-way interior point method: `resolve(x, y)` without intersections.

mod error;
mod observer;
mod params;
mod resolver;
mod statistics;

pub use error::ResolveError;
pub use observer::{AcceptedState, Observer};
pub use params::{BackwardParams, Params, StopParams, StopRule};
pub use resolver::{Call, Resolver};
pub use statistics::{Skipped, StageSeconds, Statistics};
