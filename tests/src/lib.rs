//! Shared helpers of the integration tests: scenes known from theory, bodies of fuzz targets, degenerate
//! scenes.
//!
//! - [`bowknot_safety`]: hard collision problems, and a check of every step that moves them;
//! - [`degenerate`]: spikes, wedges, notches, sheets a micrometer apart;
//! - [`contact`], [`theory`]: scenes whose outcome is known from theory;
//! - [`fuzz`]: properties that hold for any bytes, for the fuzz targets and a test.

pub mod contact;
pub mod degenerate;
pub mod fuzz;
pub mod theory;

pub use bowknot_safety::{Case, Random, StepChecker, random, states};
