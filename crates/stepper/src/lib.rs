//! The forward step: moves vertices toward a target along paths that are certified free of
//! intersections, by distances alone.

mod params;

pub use params::{Bound, Budget, StepperParams};
