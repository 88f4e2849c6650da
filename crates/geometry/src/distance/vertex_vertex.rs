//! Two vertices.

use super::arithmetic::{in_range, norm};
use super::closest_points::Closest;
use super::rescale::closest_rescaled;
use crate::pair::PairKind;
use crate::point::Point;

/// Distance of two vertices.
#[inline]
pub fn vertex_vertex(a: &Point, b: &Point) -> Closest {
    let closest = core(a, b);
    if in_range(closest.offset.norm_squared()) {
        return closest;
    }
    let origin = Point::origin();
    closest_rescaled(PairKind::VertexVertex, &[*a, *b, origin, origin], |[a, b, ..]| core(a, b))
}

#[inline(always)]
fn core(a: &Point, b: &Point) -> Closest {
    let offset = a - b;
    Closest { weights: [1.0, 1.0, 0.0, 0.0], offset, distance: norm(&offset, offset.norm_squared()) }
}
