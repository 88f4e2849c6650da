//! Contact and edge-length constraints: values, Jacobians, colours.

mod params;

pub use params::{ConstraintParams, ContactForm, EdgeForm, EdgeReference};
