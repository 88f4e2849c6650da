//! Analytic half-spaces: grounds and walls.

use crate::point::{Point, Vector};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// The solid below a plane: points with `normal . x < offset` are inside. With an offset of minus infinity it
/// is empty, and meets nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct HalfSpace {
    /// Outward unit normal.
    pub normal: Vector,
    /// Signed distance of the plane from the origin along the normal [m].
    pub offset: f64,
}

impl HalfSpace {
    /// The half-space below the plane through `point` with outward `normal` of any length but zero. `None` if
    /// the normal has no direction or a number is not finite.
    pub fn new(point: Point, normal: Vector) -> Option<Self> {
        let length = normal.norm();
        let normal = normal / length;
        let offset = normal.dot(&point.coords);
        // The offset is not-a-number if the normal is.
        (length.is_finite() && length > 0.0 && offset.is_finite()).then_some(Self { normal, offset })
    }

    /// The half-space with normal . x < offset, for a `normal` of any length but zero, which `offset` is relative to; a
    /// normal that is a unit up to rounding is kept bit by bit. `None` if the normal has no direction or a number
    /// is not finite.
    pub fn of_plane(normal: Vector, offset: f64) -> Option<Self> {
        let length = normal.norm();
        let scale = if (length - 1.0).abs() < 1e-12 { 1.0 } else { length };
        (length.is_finite() && length > 0.0 && offset.is_finite())
            .then(|| Self { normal: normal / scale, offset: offset / scale })
    }

    /// The half-space while it is not there: empty, of the same normal.
    #[must_use]
    pub fn absent(self) -> Self {
        Self { offset: f64::NEG_INFINITY, ..self }
    }

    /// Whether no point is inside, however far down.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.offset == f64::NEG_INFINITY
    }

    /// Signed distance of a point from the plane [m], positive outside.
    #[inline]
    pub fn signed_distance(&self, point: &Point) -> f64 {
        self.normal.dot(&point.coords) - self.offset
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_space_knows_its_plane_and_its_outside() {
        let ground = HalfSpace::new(Point::new(3.0, -2.0, 0.5), Vector::new(0.0, 0.0, 4.0)).unwrap();
        assert_eq!(ground, HalfSpace { normal: Vector::z(), offset: 0.5 });
        assert_eq!(ground.signed_distance(&Point::new(7.0, 8.0, 2.0)), 1.5);
        assert_eq!(ground.signed_distance(&Point::new(7.0, 8.0, 0.0)), -0.5);
        let wall = HalfSpace::new(Point::new(1.0, 1.0, 1.0), Vector::new(1.0, 2.0, 2.0)).unwrap();
        assert!((wall.signed_distance(&Point::new(2.0, 3.0, 3.0)) - 3.0).abs() < 1e-15);
        let scaled = HalfSpace::of_plane(3.0 * wall.normal, 3.0 * wall.offset).unwrap();
        assert!((scaled.normal - wall.normal).norm() < 1e-15 && (scaled.offset - wall.offset).abs() < 1e-15);
        assert_eq!(HalfSpace::of_plane(wall.normal, wall.offset), Some(wall));
        assert_eq!(HalfSpace::of_plane(Vector::zeros(), 1.0), None);
        assert_eq!(HalfSpace::of_plane(Vector::z(), f64::INFINITY), None);
        assert!(wall.absent().is_empty() && !wall.is_empty());
        assert_eq!(wall.absent().signed_distance(&Point::new(0.0, 0.0, -1e60)), f64::INFINITY);
    }

    #[test]
    fn a_normal_without_direction_is_refused() {
        let origin = Point::origin();
        assert_eq!(HalfSpace::new(origin, Vector::zeros()), None);
        assert_eq!(HalfSpace::new(origin, Vector::new(f64::NAN, 0.0, 1.0)), None);
        assert_eq!(HalfSpace::new(origin, Vector::new(f64::INFINITY, 0.0, 1.0)), None);
        assert_eq!(HalfSpace::new(Point::new(f64::NAN, 0.0, 0.0), Vector::z()), None);
    }
}
