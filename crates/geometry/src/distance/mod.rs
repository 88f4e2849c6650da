//! Closest points and distances of the pair kinds.
//!
//! Every function works with coordinate differences inside the pair, so a large common offset costs
//! no accuracy beyond what the coordinates themselves have lost. The points that the weights name
//! always lie on both sides, hence `distance` is never below the true distance by more than
//! rounding; it is off by at most 8 rounding units (2^-53) times the largest coordinate difference
//! within the pair, for every input: zero-length edges, collinear and sliver triangles, parallel
//! edges and coincident points included (`tests/suite/exact_distance.rs` compares with integers and
//! sees less than 4).
//!
//! The gradient of the distance by vertex i is `sign_i * weights[i] * offset / distance`, with sign
//! +1 on side *a* and -1 on side *b* (the closest points move, but at a minimum that adds nothing).
//! Where the closest points are not unique (parallel edges) or coincide it has no gradient; the
//! weights are then those of one choice, the same for the same input.

mod edge_edge;
mod rescale;
mod vertex_edge;
mod vertex_triangle;
mod vertex_vertex;

#[cfg(test)]
mod tests;

use crate::{PairKind, Point, Vector};
use std::hint::select_unpredictable;

pub use edge_edge::edge_edge;
pub use vertex_edge::vertex_edge;
pub use vertex_triangle::vertex_triangle;
pub use vertex_vertex::vertex_vertex;

pub(crate) use rescale::{Local, MAX_SCALE, MIN_SCALE};

/// The closest points of a pair: p on side *a*, q on side *b*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Barycentric weights of p and q over the pair's vertices in [`PairKind`] order, each in
    /// [0, 1]; the weights of each side sum to 1 (up to rounding), unused places are 0.
    pub weights: [f64; 4],
    /// p - q [m].
    pub offset: Vector,
    /// |p - q| [m].
    pub distance: f64,
}

/// Closest points of any pair kind but [`PairKind::VertexHalfSpace`]; unused points are ignored.
///
/// A half-space is no set of points: asked for [`PairKind::VertexHalfSpace`] the answer is that of
/// the vertex with itself, distance zero; use [`crate::HalfSpace::signed_distance`].
#[inline]
pub fn closest(kind: PairKind, points: &[Point; 4]) -> Closest {
    let [p0, p1, p2, p3] = points;
    match kind {
        PairKind::VertexVertex => vertex_vertex(p0, p1),
        PairKind::VertexEdge => vertex_edge(p0, [p1, p2]),
        PairKind::VertexTriangle => vertex_triangle(p0, [p1, p2, p3]),
        PairKind::EdgeEdge => edge_edge([p0, p1], [p2, p3]),
        PairKind::VertexHalfSpace => {
            Closest { weights: [1.0, 0.0, 0.0, 0.0], offset: Vector::zeros(), distance: 0.0 }
        }
    }
}

/// Clamps to [0, 1]; not-a-number (0/0 of a zero-length edge) becomes 0. Written so that it compiles
/// to two instructions, which `f64::max` with its care for both operands does not.
#[inline(always)]
fn clamp_unit(t: f64) -> f64 {
    let t = if t > 0.0 { t } else { 0.0 };
    if t < 1.0 { t } else { 1.0 }
}

/// One of two vectors, without a branch: which one cannot be predicted here.
#[inline(always)]
fn select(condition: bool, yes: Vector, no: Vector) -> Vector {
    yes.zip_map(&no, |y, n| select_unpredictable(condition, y, n))
}

/// Length of a vector whose squares may underflow.
#[inline(always)]
pub(crate) fn norm(v: &Vector, norm_squared: f64) -> f64 {
    // Below this the smallest square may have lost bits to underflow.
    const SAFE: f64 = 1e-280;
    if norm_squared > SAFE { norm_squared.sqrt() } else { rescale::norm_of_tiny(v) }
}

/// Whether squares and fourth powers of a pair's differences stay clear of overflow and underflow,
/// given the sum of some squares that bounds all of them within a small factor.
#[inline(always)]
fn in_range(squares: f64) -> bool {
    squares > MIN_SCALE * MIN_SCALE && squares < MAX_SCALE * MAX_SCALE
}
