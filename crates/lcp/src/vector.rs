//! Vectors of three and of two components.

/// A node's position or displacement, or a gradient.
pub type Vector = nalgebra::Vector3<f64>;
/// A friction multiplier or slip along two tangents.
pub type TangentVector = nalgebra::Vector2<f64>;
