//!
//! - [`bowknot_safety`]: hard collision problems, and a check of every step that moves them;
//! - [`contact`], [`theory`]: scenes whose outcome is known from theory;
//! - [`fuzz`]: properties that hold for any bytes, for the fuzz targets and a test.

pub mod contact;
pub mod fuzz;
pub mod theory;

pub use bowknot_safety::{Case, Random, StepChecker, random, states};
