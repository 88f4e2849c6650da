//! What a distance function returns.

use crate::point::Vector;

/// The closest points of a pair: p on side *a*, q on side *b*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Barycentric weights of p and q over the pair's vertices in [`crate::PairKind`] order, each in [0, 1];
    /// the weights of each side sum to 1 (up to rounding), unused places are 0.
    pub weights: [f64; 4],
    /// p - q [m].
    pub offset: Vector,
    /// |p - q| [m].
    pub distance: f64,
}
