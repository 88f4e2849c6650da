#![doc = include_str!("../README.md")]
//!
//! ## Units
//!
//! Positions and row values share one unit, usually meters. With weights relative to their mean, multipliers
//! have it too.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod colors;
mod error;
mod exact;
mod gauss_seidel;
mod info;
mod jacobi;
mod kernels;
mod multipliers;
mod params;
mod problem;
mod residual;
mod rows;
mod schedule;
mod slots;
mod state;
mod team;
mod vector;

pub use bowknot_errors::{Errors, ParamError, Parameters};
/// The crate of the types [`Vector`] and [`TangentVector`].
pub use nalgebra;

pub use colors::validate_colors;
pub use error::LcpError;
pub use exact::{delassus, solve_dense, solve_exact};
pub use gauss_seidel::{GaussSeidel, solve_colored, solve_serial, sweep_colored, sweep_serial};
pub use info::LcpInfo;
pub use jacobi::Jacobi;
pub use multipliers::apply_multipliers;
pub use params::{FrictionBound, LcpParams};
pub use problem::LcpProblem;
pub use residual::{Residuals, residuals};
pub use rows::{DistanceLimit, FrictionRow, Row, prepare_friction, prepare_rows};
pub use schedule::{ConstraintSet, Schedule};
pub use state::LcpState;
pub use vector::{TangentVector, Vector};
