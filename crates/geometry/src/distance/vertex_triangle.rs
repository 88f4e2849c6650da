//! A vertex and a triangle.

use super::arithmetic::{in_range, norm, select};
use super::closest_points::Closest;
use super::rescale::closest_rescaled;
use super::vertex_edge::foot_on_edge;
use crate::pair::PairKind;
use crate::point::{Point, Vector};

/// Closest points of a vertex and a triangle, which may have zero area.
#[inline]
pub fn vertex_triangle(a: &Point, b: [&Point; 3]) -> Closest {
    let (closest, squares) = core(a, b);
    if in_range(squares) {
        return closest;
    }
    let points = [*a, *b[0], *b[1], *b[2]];
    closest_rescaled(PairKind::VertexTriangle, &points, |[a, b0, b1, b2]| core(a, [b0, b1, b2]).0)
}

/// The closest points, and a sum of squares that bounds all differences.
#[inline(always)]
fn core(a: &Point, b: [&Point; 3]) -> (Closest, f64) {
    let (e1, e2, r) = (b[1] - b[0], b[2] - b[0], a - b[0]);
    // The foot in the plane by orthogonalisation: along e1, then along the part of e2 that is perpendicular
    // to e1. Each step subtracts the larger part before it measures the smaller one. So the error of the foot
    // is only rounding of the lengths, even in slivers, where ratios of areas or of Gram determinants cancel
    // many digits. In a sliver of height h the direction of the plane is off by u L/h, hence the distance d
    // by (u L/h)^2 d; but for any foot inside the triangle it is also off by at most h^2/d, and the smaller
    // of both is below u L. So slivers are no special case. The weights are not-a-number where e1 or the area
    // is zero.
    let (e1e1, e2e2) = (e1.norm_squared(), e2.norm_squared());
    let shear = e1.dot(&e2) / e1e1;
    let height = e2 - e1 * shear;
    let hh = height.norm_squared();
    let along = r.dot(&e1) / e1e1;
    let from_line = r - e1 * along;
    let w2 = from_line.dot(&height) / hh;
    let w1 = along - shear * w2;
    let w0 = 1.0 - w1 - w2;
    let inside = w0 > 0.0 && w1 > 0.0 && w2 > 0.0;

    let (weights, offset) =
        if inside { (Vector::new(w0, w1, w2), from_line - height * w2) } else { closest_edge(a, b) };
    let weights = [1.0, weights.x, weights.y, weights.z];
    let offset_squared = offset.norm_squared();
    let closest = Closest { weights, offset, distance: norm(&offset, offset_squared) };
    (closest, offset_squared + e1e1 + e2e2)
}

/// The closer of two candidates (weights and offset), the first of equals.
#[inline(always)]
fn closer(first: (Vector, Vector), second: (Vector, Vector)) -> (Vector, Vector) {
    let is_second = second.1.norm_squared() < first.1.norm_squared();
    (select(is_second, second.0, first.0), select(is_second, second.1, first.1))
}

/// Weights and offset of the closest of the feet on the three edges, the first of equals.
#[inline(always)]
fn closest_edge(a: &Point, b: [&Point; 3]) -> (Vector, Vector) {
    let (t01, o01) = foot_on_edge(a, [b[0], b[1]]);
    let (t12, o12) = foot_on_edge(a, [b[1], b[2]]);
    let (t20, o20) = foot_on_edge(a, [b[2], b[0]]);
    let first = closer((Vector::new(1.0 - t01, t01, 0.0), o01), (Vector::new(0.0, 1.0 - t12, t12), o12));
    closer(first, (Vector::new(t20, 0.0, 1.0 - t20), o20))
}
