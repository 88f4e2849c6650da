//! The methods that the two-way interior point method is compared with.
//!
//! Each is a [`Method`]: it moves positions from an intersection-free state toward a target. Methods that differ from the
//! two-way method in one stage are its loop with another stage ([`Composed`]), so that a comparison tells what that stage
//! makes of it.

pub mod barrier;
pub mod ccd;
mod method;
pub mod rows;
pub mod zones;

pub use method::{Composed, Method, Outcome};

/// The two-way method, its problems and stages.
pub use bowknot_twoway as twoway;
