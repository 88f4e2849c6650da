#![doc = include_str!("../README.md")]
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
