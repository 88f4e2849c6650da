//! A vertex and a triangle.

use super::vertex_edge::foot_on_edge;
use super::{Closest, in_range, norm, rescale};
use crate::{PairKind, Point, Vector};

/// Squared sine between two edges of a triangle below which it is a sliver: the foot in its plane
/// is then one candidate among others instead of the answer. Above it, barycentric coordinates are
/// off by at most about 1e3 rounding units, and the distance by their square.
const SLIVER: f64 = 1e-6;

/// Closest points of a vertex and a triangle, which may have zero area.
#[inline]
pub fn vertex_triangle(a: &Point, b: [&Point; 3]) -> Closest {
    let (closest, squares) = core(a, b);
    if in_range(squares) {
        return closest;
    }
    let points = [*a, *b[0], *b[1], *b[2]];
    rescale::closest_rescaled(PairKind::VertexTriangle, &points, |[a, b0, b1, b2]| core(a, [b0, b1, b2]).0)
}

/// The closest points, and a sum of squares that bounds all differences.
#[inline(always)]
fn core(a: &Point, b: [&Point; 3]) -> (Closest, f64) {
    let (e1, e2, r) = (b[1] - b[0], b[2] - b[0], a - b[0]);
    let normal = e1.cross(&e2);
    let (e1e1, e2e2, nn) = (e1.norm_squared(), e2.norm_squared(), normal.norm_squared());
    // Barycentric coordinates as ratios of areas along the normal. (Ratios of Gram determinants
    // cancel twice as many digits in slivers.) Not-a-number where the area is zero.
    let w1 = r.cross(&e2).dot(&normal) / nn;
    let w2 = e1.cross(&r).dot(&normal) / nn;
    let w0 = 1.0 - w1 - w2;
    let inside = w0 > 0.0 && w1 > 0.0 && w2 > 0.0;
    let sliver = nn <= SLIVER * e1e1 * e2e2;

    let (weights, offset) = if inside && !sliver {
        ([1.0, w0, w1, w2], r - e1 * w1 - e2 * w2)
    } else {
        let edges = closest_edge(a, b);
        if !inside {
            edges
        } else {
            let offset = r - e1 * w1 - e2 * w2;
            if offset.norm_squared() < edges.1.norm_squared() { ([1.0, w0, w1, w2], offset) } else { edges }
        }
    };
    let offset_squared = offset.norm_squared();
    let closest = Closest { weights, offset, distance: norm(&offset, offset_squared) };
    (closest, offset_squared + e1e1 + e2e2)
}

/// The closest of the feet on the three edges, the first of equals; without branches but the choice.
#[inline(always)]
fn closest_edge(a: &Point, b: [&Point; 3]) -> ([f64; 4], Vector) {
    let (t01, o01) = foot_on_edge(a, [b[0], b[1]]);
    let (t12, o12) = foot_on_edge(a, [b[1], b[2]]);
    let (t20, o20) = foot_on_edge(a, [b[2], b[0]]);
    let mut best = ([1.0, 1.0 - t01, t01, 0.0], o01);
    let mut least = o01.norm_squared();
    let squared = o12.norm_squared();
    if squared < least {
        best = ([1.0, 0.0, 1.0 - t12, t12], o12);
        least = squared;
    }
    if o20.norm_squared() < least {
        best = ([1.0, t20, 0.0, 1.0 - t20], o20);
    }
    best
}
