//! Shapes that move by themselves.

use bowknot_geometry::Point;
use std::fmt;

/// A generated shape whose vertices move: what an obstacle of that shape follows.
///
/// The vertices are those of [`Shape::mesh`](crate::shapes::Shape::mesh), in its order and in the shape's own
/// axes; their places must be continuous in time, and the same at every call.
pub trait Animated: fmt::Debug + Send + Sync {
    /// Where all vertices are at a time [s], from 0 [m].
    fn positions(&self, time: f64) -> Vec<Point>;
}
