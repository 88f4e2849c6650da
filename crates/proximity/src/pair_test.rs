//! The kinds of pairs that trees search for, and the certified `f32` test of each.
//!
//! For any vector d, min over side a of d.x - max over side b of d.x <= |d| times the distance of the sides
//! (weak duality). So d need not be accurate: here it joins closest points computed in `f32`. If the slab
//! along d is wider than the radii by more than the rounding error, the pair is certainly farther apart than
//! its radii (`rejected`). If |d| is below the radii by more than the rounding error, the pair is certainly
//! nearer (`accepted`), because d joins two points of the sides. The few pairs in between are left to `f64`.
//!
//! **Rounding.** With u = 2^-24 and m the largest local coordinate of both elements, stored coordinates are
//! off by u m, and so each coordinate of the computed differences r = a0 - b0, a1 - a0, .. by 2 u m + u 2 m =
//! 4 u m. A dot product of a difference with d (exact as stored) adds 3 u (2 m) |d|_1, so each of the up to
//! three products is off by 10 u m |d|_1, and their sums round by another 12 u m |d|_1: altogether 42 u
//! m |d|_1 <= 73 u m |d|. The row's `slack` is 80 u m, each side with its own m, and the radius is compared
//! with a factor 1 + 16 u, for the rounding of the radius and of |d|. For the other test, the point of a side
//! with computed weights in [0, 1] is off by 4 u m for each difference and 6 u (6 m) for its operations,
//! together below 60 u m per coordinate and 104 u m in length; 1.6 times the slack, 128 u m, is subtracted.
//! Products of tiny numbers may underflow: below a length |d| of 1e-12 m nothing is rejected, and above it
//! 1e-18 m of slack covers errors of 1e-44.
//!
//! **Lower bounds.** A pair is farther apart than every R with (R (1 + 16 u) + s) |d| (1 + 16 u) < width,
//! where s is the slack. With q = width / |d| as computed, R = (q (1 - 64 u) - s)(1 - 64 u) is such a number
//! where it is positive: then s < q, and the left side is below |d| (q (1 - 112 u) + 48 u s) (1 + 20 u) < |d|
//! q (1 - 40 u), which is below the width.

use crate::bits::{bits, flag};
use crate::frame::UNIT_ROUNDOFF;
use crate::min_max::{larger, smaller};
use crate::tree::LANES;
use bowknot_geometry::PairKind;

/// The `f32` test of one kind of pair, with `A` vertices on side *a* and `B` on side *b*.
pub trait PairTest<const A: usize, const B: usize>: Sync {
    /// The kind of pair.
    const KIND: PairKind;
    /// Whether both sides come from the same list, so that each pair would be found twice.
    const SYMMETRIC: bool;

    /// The vector from a point of side *b* to a point of side *a*; the points are closest up to rounding.
    fn direction(a: &[[f32; 3]; A], b: &[[f32; 3]; B]) -> [f32; 3];
}

/// Two particles.
pub struct VertexVertex;
/// A particle and a strand edge.
pub struct VertexEdge;
/// A vertex and a triangle.
pub struct VertexTriangle;
/// Two edges.
pub struct EdgeEdge;

/// Results of the `f32` test for sixteen pairs.
#[derive(Clone, Copy, Debug)]
pub struct Verdicts {
    /// Pairs that are certainly farther apart than their radii, one bit each.
    pub rejected: u32,
    /// Pairs that are certainly nearer than their radii, one bit each.
    pub accepted: u32,
    /// Certified lower bounds of the distances [m], at least 0.
    pub bounds: [f32; LANES],
}

/// Sixteen pairs side by side: local coordinates of both sides' vertices [m], and the sums of the sides'
/// radii and slacks of [`crate::tree::ElementRow`] [m].
#[repr(C, align(64))]
pub struct Batch<const A: usize, const B: usize> {
    pub a: [[[f32; LANES]; 3]; A],
    pub b: [[[f32; LANES]; 3]; B],
    pub radius: [f32; LANES],
    pub slack: [f32; LANES],
}

/// Tests sixteen pairs.
#[inline(always)]
pub fn classify<K: PairTest<A, B>, const A: usize, const B: usize>(batch: &Batch<A, B>) -> Verdicts {
    let mut rejected = [0_u8; LANES];
    let mut accepted = [0_u8; LANES];
    let mut bounds = [0.0; LANES];
    for lane in 0..LANES {
        let mut a = [[0.0; 3]; A];
        let mut b = [[0.0; 3]; B];
        for k in 0..3 {
            for i in 0..A {
                a[i][k] = batch.a[i][k][lane];
            }
            for j in 0..B {
                b[j][k] = batch.b[j][k][lane];
            }
        }
        let d = K::direction(&a, &b);
        let mut width = dot(d, sub(a[0], b[0]));
        let mut below = 0.0;
        for i in 1..A {
            below = smaller(dot(d, sub(a[i], a[0])), below);
        }
        let mut above = 0.0;
        for j in 1..B {
            above = larger(dot(d, sub(b[j], b[0])), above);
        }
        width = width + below - above;
        let squared = dot(d, d);
        let length = squared.sqrt();
        let (radius, slack) = (batch.radius[lane], batch.slack[lane]);
        let reject = radius * (1.0 + 16.0 * UNIT_ROUNDOFF) + slack;
        let accept = radius * (1.0 - 16.0 * UNIT_ROUNDOFF) - 1.6 * slack;
        let far = width > reject * length * (1.0 + 16.0 * UNIT_ROUNDOFF);
        let certain = squared > 1e-24;
        rejected[lane] = flag(far & certain);
        accepted[lane] = flag(length < accept);
        const SMALLER: f32 = 1.0 - 64.0 * UNIT_ROUNDOFF;
        let bound = (width / length * SMALLER - slack) * SMALLER;
        bounds[lane] = if certain { larger(bound, 0.0) } else { 0.0 };
    }
    Verdicts { rejected: bits(&rejected), accepted: bits(&accepted), bounds }
}

impl PairTest<1, 1> for VertexVertex {
    const KIND: PairKind = PairKind::VertexVertex;
    const SYMMETRIC: bool = true;

    #[inline(always)]
    fn direction([a]: &[[f32; 3]; 1], [b]: &[[f32; 3]; 1]) -> [f32; 3] {
        sub(*a, *b)
    }
}

impl PairTest<1, 2> for VertexEdge {
    const KIND: PairKind = PairKind::VertexEdge;
    const SYMMETRIC: bool = false;

    #[inline(always)]
    fn direction([p]: &[[f32; 3]; 1], [b0, b1]: &[[f32; 3]; 2]) -> [f32; 3] {
        from_segment(sub(*p, *b0), sub(*b1, *b0))
    }
}

impl PairTest<1, 3> for VertexTriangle {
    const KIND: PairKind = PairKind::VertexTriangle;
    const SYMMETRIC: bool = false;

    /// The shortest of four vectors: from the nearest point of each edge, and from the foot in the plane if
    /// that is inside the triangle.
    #[inline(always)]
    fn direction([p]: &[[f32; 3]; 1], [b0, b1, b2]: &[[f32; 3]; 3]) -> [f32; 3] {
        let (ab, ac, ap) = (sub(*b1, *b0), sub(*b2, *b0), sub(*p, *b0));
        let (d1, d2) = (dot(ab, ap), dot(ac, ap));
        let (g11, g12, g22) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
        let determinant = g11 * g22 - g12 * g12;
        let (v, w) = (g22 * d1 - g12 * d2, g11 * d2 - g12 * d1);
        let inside = (v >= 0.0) & (w >= 0.0) & (v + w <= determinant) & (determinant > 0.0);
        let inverse = 1.0 / determinant;
        let foot = along(along(ap, ab, v * inverse), ac, w * inverse);

        let first = along(ap, ab, fraction(d1, g11));
        let second = along(ap, ac, fraction(d2, g22));
        let third = from_segment(sub(*p, *b1), sub(*b2, *b1));
        let best = shorter(first, shorter(second, third));
        select(inside, foot, best)
    }
}

impl PairTest<2, 2> for EdgeEdge {
    const KIND: PairKind = PairKind::EdgeEdge;
    const SYMMETRIC: bool = true;

    /// Closest points of two segments by clamping (Ericson 2005, section 5.1.9), without branches.
    #[inline(always)]
    fn direction([a0, a1]: &[[f32; 3]; 2], [b0, b1]: &[[f32; 3]; 2]) -> [f32; 3] {
        let (e, f, r) = (sub(*a1, *a0), sub(*b1, *b0), sub(*a0, *b0));
        let (ee, ef, ff) = (dot(e, e), dot(e, f), dot(f, f));
        let (er, fr) = (dot(e, r), dot(f, r));
        let determinant = ee * ff - ef * ef;
        // For nearly parallel edges any start will do: the clamped ends decide.
        let steep = determinant > 1e-6 * ee * ff;
        let s = fraction(if steep { ef * fr - er * ff } else { 0.0 }, determinant);
        let t = fraction(ef * s + fr, ff);
        let s = fraction(ef * t - er, ee);
        along(along(r, e, -s), f, t)
    }
}

/// p - q for the point q nearest to p on a segment, given p and the segment from its start.
#[inline(always)]
fn from_segment(p: [f32; 3], segment: [f32; 3]) -> [f32; 3] {
    along(p, segment, fraction(dot(p, segment), dot(segment, segment)))
}

/// numerator / denominator clamped to [0, 1]; 0 for 0 / 0.
#[inline(always)]
fn fraction(numerator: f32, denominator: f32) -> f32 {
    // Not-a-number fails the comparison and becomes 0.
    smaller(larger(numerator / denominator, 0.0), 1.0)
}

#[inline(always)]
fn shorter(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    select(dot(a, a) < dot(b, b), a, b)
}

#[inline(always)]
fn select(first: bool, a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    let pick = |k: usize| if first { a[k] } else { b[k] };
    [pick(0), pick(1), pick(2)]
}

/// p - t v.
#[inline(always)]
fn along(p: [f32; 3], v: [f32; 3], t: f32) -> [f32; 3] {
    [p[0] - t * v[0], p[1] - t * v[1], p[2] - t * v[2]]
}

#[inline(always)]
fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests;
