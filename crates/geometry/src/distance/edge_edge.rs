//! Two edges.

use super::vertex_edge::foot_on_edge;
use super::{Closest, clamp_unit, in_range, norm, rescale, select};
use crate::{PairKind, Point, Vector};
use std::hint::select_unpredictable;

/// Squared sine of the angle below which edges count as near parallel (also where one has zero
/// length): the place of the closest points is then so ill determined that the edges' ends are
/// tried as well.
const NEAR_PARALLEL: f64 = 1e-8;

/// Closest points of two edges, which may have zero length or be parallel.
#[inline]
pub fn edge_edge(a: [&Point; 2], b: [&Point; 2]) -> Closest {
    let (closest, squares) = core(a, b);
    if in_range(squares) {
        return closest;
    }
    let points = [*a[0], *a[1], *b[0], *b[1]];
    rescale::closest_rescaled(PairKind::EdgeEdge, &points, |[a0, a1, b0, b1]| core([a0, a1], [b0, b1]).0)
}

/// The closest points, and a sum of squares that bounds all differences.
#[inline(always)]
fn core(a: [&Point; 2], b: [&Point; 2]) -> (Closest, f64) {
    let (d1, d2, r) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (aa, bb, ab) = (d1.norm_squared(), d2.norm_squared(), d1.dot(&d2));
    let (per_aa, per_bb, r_d2) = (1.0 / aa, 1.0 / bb, r.dot(&d2));
    // The closest point of line a, from what of d1 and r is perpendicular to b: taking off the
    // larger part first keeps the digits that determinants of near parallel edges would cancel.
    let across = d1 - d2 * (ab * per_bb);
    let from_line = r - d2 * (r_d2 * per_bb);
    let cc = across.norm_squared();
    let s = clamp_unit(-from_line.dot(&across) / cc);
    // Clamped to edge a; then the best place on b for it, then the best on a for that: minimises
    // over the square of both places (Ericson 2004, "Real-Time Collision Detection", 5.1.9).
    let t = clamp_unit((ab * s + r_d2) * per_bb);
    let s = clamp_unit((ab * t - r.dot(&d1)) * per_aa);

    let mut place = (s, t, offset_at(a, b, &d1, &d2, s, t));
    if cc <= NEAR_PARALLEL * aa {
        place = closest_end(a, b, place);
    }
    let (s, t, offset) = place;
    let offset_squared = offset.norm_squared();
    let closest =
        Closest { weights: [1.0 - s, s, 1.0 - t, t], offset, distance: norm(&offset, offset_squared) };
    (closest, offset_squared + aa + bb)
}

/// Point at s of edge a minus point at t of edge b, each measured from its nearer end.
#[inline(always)]
fn offset_at(a: [&Point; 2], b: [&Point; 2], d1: &Vector, d2: &Vector, s: f64, t: f64) -> Vector {
    let (start_of_a, start_of_b) = (s <= 0.5, t <= 0.5);
    let near_a = select(start_of_a, a[0].coords, a[1].coords);
    let near_b = select(start_of_b, b[0].coords, b[1].coords);
    let ds = s - select_unpredictable(start_of_a, 0.0, 1.0);
    let dt = t - select_unpredictable(start_of_b, 0.0, 1.0);
    (near_a - near_b) + d1 * ds - d2 * dt
}

/// The best of the given place and the feet of the four ends on the other edge.
#[inline(never)]
fn closest_end(a: [&Point; 2], b: [&Point; 2], place: (f64, f64, Vector)) -> (f64, f64, Vector) {
    let ends_of_a = [0.0, 1.0].map(|s| {
        let (t, offset) = foot_on_edge(a[s as usize], b);
        (s, t, offset)
    });
    let ends_of_b = [0.0, 1.0].map(|t| {
        let (s, offset) = foot_on_edge(b[t as usize], a);
        (s, t, -offset)
    });
    let mut best = place;
    let mut least = place.2.norm_squared();
    for candidate in ends_of_a.into_iter().chain(ends_of_b) {
        let squared = candidate.2.norm_squared();
        if squared < least {
            best = candidate;
            least = squared;
        }
    }
    best
}
