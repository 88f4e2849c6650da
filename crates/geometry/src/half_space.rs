//! Analytic half-spaces: grounds and walls.

use crate::{Point, Vector};
use serde::{Deserialize, Serialize};

/// The solid below a plane: points with `normal . x < offset` are inside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HalfSpace {
    /// Outward unit normal.
    pub normal: Vector,
    /// Signed distance of the plane from the origin along the normal [m].
    pub offset: f64,
}

impl HalfSpace {
    /// The half-space below the plane through `point` with outward `normal` (any length but zero).
    pub fn new(point: Point, normal: Vector) -> Option<Self> {
        let length = normal.norm();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        let normal = normal / length;
        Some(Self { normal, offset: normal.dot(&point.coords) })
    }

    /// Signed distance of a point from the plane [m], positive outside.
    #[inline]
    pub fn signed_distance(&self, point: &Point) -> f64 {
        self.normal.dot(&point.coords) - self.offset
    }
}
