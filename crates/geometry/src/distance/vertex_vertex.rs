//! Two vertices.

use super::{Closest, in_range, norm, rescale};
use crate::{PairKind, Point};

/// Distance of two vertices.
#[inline]
pub fn vertex_vertex(a: &Point, b: &Point) -> Closest {
    let closest = core(a, b);
    if in_range(closest.offset.norm_squared()) {
        return closest;
    }
    let origin = Point::origin();
    rescale::closest_rescaled(PairKind::VertexVertex, &[*a, *b, origin, origin], |[a, b, ..]| core(a, b))
}

#[inline(always)]
fn core(a: &Point, b: &Point) -> Closest {
    let offset = a - b;
    Closest { weights: [1.0, 1.0, 0.0, 0.0], offset, distance: norm(&offset, offset.norm_squared()) }
}
