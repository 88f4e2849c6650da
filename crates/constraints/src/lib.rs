#![doc = include_str!("../README.md")]
// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod coloring;
mod contacts;
mod delta;
mod edges;
mod face;
mod facing;
mod friction;
mod params;
mod volume;

/// Points, pair kinds and separations, from which rows are made.
pub use bowknot_geometry as geometry;
/// The rows, and the solvers that take them.
pub use bowknot_lcp as lcp;
/// Lists of pairs, from which rows are made.
pub use bowknot_proximity as proximity;

pub use bowknot_errors::{Errors, ParamError, Parameters};
pub use coloring::Coloring;
pub use contacts::{ContactRows, SelectedPair, contact_row, predicted_gap};
pub use delta::DeltaRule;
pub use edges::{EdgeLimits, Stretch};
pub use facing::{Facing, Feature};
pub use friction::tangents;
pub use params::{ContactForm, ContactParams, EdgeForm, EdgeReference, FrictionModel, STRETCH_LIMIT};
