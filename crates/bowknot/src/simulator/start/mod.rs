//! What is checked before the first time step.

mod inside;
mod motion_range;
mod near_starts;
mod overlap;

pub(crate) use inside::{Enclosure, enclosed_bodies};
pub use near_starts::NearStart;
pub(crate) use near_starts::near_starts;
pub(crate) use overlap::advice;
