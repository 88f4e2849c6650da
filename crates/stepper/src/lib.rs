//! The forward step: moves vertices toward a target along paths that are certified free of
//! intersections, by distances alone.
//!
//! It knows pairs and their slabs; it knows no constraint and does not care where targets come from.

mod budgets;
mod params;
mod rounding;
mod stepper;

/// Points and the separations of pairs, by which steps are limited.
pub use bowknot_geometry as geometry;
/// Lists of pairs, and the bodies that they belong to.
pub use bowknot_proximity as proximity;

pub use budgets::Budgets;
pub use params::{Bound, Budget, StepperParams};
pub use rounding::Rounding;
pub use stepper::{Contacts, StepReport, Stepper};

/// The README's example is tested with the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDoctests;
