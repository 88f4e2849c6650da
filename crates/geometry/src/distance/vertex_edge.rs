//! A vertex and an edge.

use super::arithmetic::{clamp_unit, in_range, norm, select};
use super::closest_points::Closest;
use super::rescale::closest_rescaled;
use crate::pair::PairKind;
use crate::point::{Point, Vector};
use std::hint::select_unpredictable;

/// Closest points of a vertex and an edge, which may have zero length.
#[inline]
pub fn vertex_edge(a: &Point, b: [&Point; 2]) -> Closest {
    let closest = core(a, b);
    if in_range(closest.offset.norm_squared() + (b[1] - b[0]).norm_squared()) {
        return closest;
    }
    let points = [*a, *b[0], *b[1], Point::origin()];
    closest_rescaled(PairKind::VertexEdge, &points, |[a, b0, b1, _]| core(a, [b0, b1]))
}

#[inline(always)]
fn core(a: &Point, b: [&Point; 2]) -> Closest {
    let (t, offset) = foot_on_edge(a, b);
    Closest { weights: [1.0, 1.0 - t, t, 0.0], offset, distance: norm(&offset, offset.norm_squared()) }
}

/// The parameter t in [0, 1] of the point of the edge that is closest to p, and p minus that point.
#[inline(always)]
pub(super) fn foot_on_edge(p: &Point, edge: [&Point; 2]) -> (f64, Vector) {
    let along = edge[1] - edge[0];
    let from_start = p - edge[0];
    let t = clamp_unit(from_start.dot(&along) / along.norm_squared());
    // Measured from the nearer end, so that the distance from an end has the same bits as that of two
    // vertices, however long the edge.
    let near_start = t <= 0.5;
    let from_near = select(near_start, from_start, p - edge[1]);
    let offset = from_near - along * (t - select_unpredictable(near_start, 0.0, 1.0));
    (t, offset)
}
