//! Points and vectors of three components.

/// A position [m].
pub type Point = nalgebra::Point3<f64>;
/// A displacement, direction or force; the unit is stated where it is used.
pub type Vector = nalgebra::Vector3<f64>;
