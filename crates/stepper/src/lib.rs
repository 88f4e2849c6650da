//! The forward step: moves vertices toward a target along paths that are certified free of
//! intersections, by distances alone.
//!
//! [`Forward`] is the step with everything that makes it safe: search, slabs, trust regions. [`Stepper`] has
//! the same as loose calls, for solvers that keep lists of their own; alone, none of these makes a step safe.
//!
//! The crate knows pairs and their slabs. It knows no constraint, and not where targets come from.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod error;
mod forward;
mod params;
mod rounding;
mod stepper;
mod trust_regions;

/// Points and the separations of pairs, by which steps are limited.
pub use bowknot_geometry as geometry;
/// Lists of pairs, and the bodies that they belong to.
pub use bowknot_proximity as proximity;

pub use bowknot_errors::{Errors, ParamError, Parameters};
pub use error::ForwardError;
pub use forward::{Forward, ForwardOptions, ForwardReport};
pub use params::{Bound, ForwardParams, TrustRegionRule};
pub use rounding::Rounding;
pub use stepper::{Contacts, StepReport, Stepper, Tubes};
pub use trust_regions::TrustRegions;

/// The README's example is tested with the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDoctests;
