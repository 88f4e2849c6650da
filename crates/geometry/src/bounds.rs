//! Axis-aligned boxes rounded outward, and certified lower bounds of distances from them.

use crate::Point;

/// An axis-aligned box [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Point,
    /// Largest coordinates.
    pub max: Point,
}
