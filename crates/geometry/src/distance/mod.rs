//! Closest points and distances of the pair kinds.
//!
//! Every function works with coordinate differences inside the pair, so a large common offset costs no
//! accuracy beyond what the coordinates themselves have lost. The points that the weights define always lie
//! on the two sides, hence `distance` is never below the true distance by more than rounding. Its error is at
//! most 8 rounding units (2^-53) times the largest coordinate difference within the pair, for every input,
//! including zero-length edges, collinear and sliver triangles, parallel edges and coincident points
//! (`tests/suite/exact_distance.rs` compares with integers and finds less than 4).
//!
//! The gradient of the distance by vertex i is `sign_i * weights[i] * offset / distance`, with sign +1 on
//! side *a* and -1 on side *b*. (The closest points move too, but at a minimum that contributes nothing.) The
//! distance has no gradient where the closest points are not unique (parallel edges) or coincide. The weights
//! are then those of one choice, the same for the same input.
//!
//! Points that are not finite are at no distance: the result is NaN, or infinite.

mod arithmetic;
mod closest_points;
mod edge_edge;
mod rescale;
mod vertex_edge;
mod vertex_triangle;
mod vertex_vertex;

use crate::pair::PairKind;
use crate::point::{Point, Vector};

pub use closest_points::Closest;
pub use edge_edge::edge_edge;
pub use vertex_edge::vertex_edge;
pub use vertex_triangle::vertex_triangle;
pub use vertex_vertex::vertex_vertex;

pub(crate) use rescale::{Local, MAX_SCALE, MIN_SCALE};

/// Closest points of any pair kind but [`PairKind::VertexHalfSpace`]; unused points are ignored.
///
/// A half-space has no vertices. For [`PairKind::VertexHalfSpace`] the result is that of the vertex with
/// itself, with a distance of zero; use [`crate::HalfSpace::signed_distance`].
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

#[cfg(test)]
mod tests;
