//! What is checked before the first time step.

mod inside;
mod motion_range;
mod near_starts;
mod overlap;
mod own_world;

pub(crate) use inside::{Enclosure, enclosed_bodies};
pub use near_starts::NearStart;
pub(crate) use near_starts::near_starts;
pub(crate) use overlap::advice;
pub(crate) use own_world::check_world;
