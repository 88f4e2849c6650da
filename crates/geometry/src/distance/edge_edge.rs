//! Two edges.

use super::arithmetic::{clamp_unit, in_range, norm, select};
use super::closest_points::Closest;
use super::rescale::closest_rescaled;
use crate::pair::PairKind;
use crate::point::{Point, Vector};
use std::hint::select_unpredictable;

/// Closest points of two edges, which may have zero length or be parallel.
#[inline]
pub fn edge_edge(a: [&Point; 2], b: [&Point; 2]) -> Closest {
    let (closest, squares) = core(a, b);
    if in_range(squares) {
        return closest;
    }
    let points = [*a[0], *a[1], *b[0], *b[1]];
    closest_rescaled(PairKind::EdgeEdge, &points, |[a0, a1, b0, b1]| core([a0, a1], [b0, b1]).0)
}

/// The closest points, and a sum of squares that bounds all differences.
#[inline(always)]
fn core(a: [&Point; 2], b: [&Point; 2]) -> (Closest, f64) {
    let (d1, d2, r) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (aa, bb, ab) = (d1.norm_squared(), d2.norm_squared(), d1.dot(&d2));
    let (per_aa, per_bb, r_d2) = (1.0 / aa, 1.0 / bb, r.dot(&d2));
    // The closest point of line a, from the parts of d1 and r that are perpendicular to b. Subtracting the
    // larger part first keeps the digits that would cancel in the determinants of nearly parallel edges.
    let across = d1 - d2 * (ab * per_bb);
    let from_line = r - d2 * (r_d2 * per_bb);
    let cc = across.norm_squared();
    let s = clamp_unit(-from_line.dot(&across) / cc);
    // s is clamped to edge a. The next two lines find the best t on b for this s, and the best s on a for
    // that t: together they minimize over the square of both parameters (Ericson 2004, "Real-Time Collision
    // Detection", 5.1.9). At a small angle g the first s is off by u (L g + d)/(L g^2), which moves the
    // points apart by g times that; but from any s the next two lines find a distance within (L g)^2/d of the
    // smallest. The smaller of both errors is below u L, so nearly parallel edges are no special case. For
    // parallel edges (0/0 = not-a-number, taken as 0) and edges of zero length any s gives the right result.
    let t = clamp_unit((ab * s + r_d2) * per_bb);
    let s = clamp_unit((ab * t - r.dot(&d1)) * per_aa);

    let offset = offset_at(a, b, &d1, &d2, s, t);
    let offset_squared = offset.norm_squared();
    let closest =
        Closest { weights: [1.0 - s, s, 1.0 - t, t], offset, distance: norm(&offset, offset_squared) };
    (closest, offset_squared + aa + bb)
}

/// The point at s of edge a minus the point at t of edge b, each measured from its nearer end.
#[inline(always)]
fn offset_at(a: [&Point; 2], b: [&Point; 2], d1: &Vector, d2: &Vector, s: f64, t: f64) -> Vector {
    let (start_of_a, start_of_b) = (s <= 0.5, t <= 0.5);
    let near_a = select(start_of_a, a[0].coords, a[1].coords);
    let near_b = select(start_of_b, b[0].coords, b[1].coords);
    let ds = s - select_unpredictable(start_of_a, 0.0, 1.0);
    let dt = t - select_unpredictable(start_of_b, 0.0, 1.0);
    (near_a - near_b) + d1 * ds - d2 * dt
}
