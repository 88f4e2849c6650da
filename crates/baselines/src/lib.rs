#![doc = include_str!("../README.md")]
//!
//! ## Modules
//!
//! | module | holds | knows nothing of |
//! |---|---|---|
//! | [`barrier`] | the log-barrier interior point method | rows, zones |
//! | [`ccd`] | forward steps by continuous collision detection | rows, zones, barriers |
//! | [`rows`] | other solvers of the backward step's rows | impacts, barriers |
//! | [`zones`] | impact zones | barriers |

pub mod barrier;
pub mod ccd;
mod geometry;
mod method;
pub mod rows;
pub mod zones;

pub use bowknot_errors::{Errors, ParamError, Parameters};
pub use method::{Composed, Method, Outcome};

/// The two-way method, its problems and stages.
pub use bowknot_twoway as twoway;
