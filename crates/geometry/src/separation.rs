//! Certified separation: a direction and a slab width that never exceeds the true distance.
//!
//! For a unit vector n the slab width w(n) = min over side a of n.x - max over side b of n.x is at most the
//! true distance of the sides, for any n (weak duality: for any p in a, q in b,
//! |p - q| >= n.(p - q) >= w). In the direction of the closest points it equals the distance. So the direction need not
//! be accurate; only the evaluation of w must be:
//!
//! **Rounding of the width.** Let u = 2^-53 and m the largest absolute coordinate of the differences x_a -
//! x_b over all vertices a, b of the two sides. A computed difference is the true one up to a factor 1 +
//! e, |e| <= u, in each coordinate; the dot product with the vector n as it is stored adds three more such
//! factors, so each n.(x_a - x_b) is off by at most 4u/(1 - 4u) * sum |n_j| |x_a - x_b|_j <= 4.01 u *
//! sqrt(3) |n| m, and so is their minimum. Further, n = v / |v| as `unit` computes it has | |n| - 1 | <= 5u
//! (sum of squares 3u, halved by the root, root u, reciprocal u, product u), and dividing by the true |n|
//! moves the width by at most 5.01 u * sqrt(3) m. Subtracting the bound rounds by 1.8 u m. Altogether less
//! than 17.5 u m; `WIDTH_ROUNDING` is 20 u. Differences beyond [1e-70, 1e70] m are scaled by a power of two,
//! so that underflow (errors of 2^-1074) stays far below that.

mod slab;
mod triangles;

use crate::distance::{self, Local, MAX_SCALE, MIN_SCALE};
use crate::half_space::HalfSpace;
use crate::pair::PairKind;
use crate::point::{Point, Vector};
use slab::{
    MIN_WIDTH_RATIO, MOVED_WIDTH_ROUNDING, Slab, WIDTH_ROUNDING, largest_coordinate, smallest_dot, unit,
};

pub use triangles::{TriangleFeature, TriangleSeparation, triangle_triangle};

/// A pair's contact geometry, with a certified lower bound of its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Unit direction (to rounding) from side *b* to side *a*.
    pub normal: Vector,
    /// Barycentric weights of the closest points, see [`crate::Closest::weights`].
    pub weights: [f64; 4],
    /// Computed distance of the closest points [m]; it may be slightly too small or too large.
    pub distance: f64,
    /// Certified width of the slab between the sides along `normal` [m]: in exact arithmetic min over side a
    /// of n.x - max over side b of n.x is at least `width` for a unit n parallel to `normal`, hence so is the
    /// true distance. It may be negative if no direction certifies a gap.
    pub width: f64,
}

impl Separation {
    /// Weights with the sign of the change of the gap: + on side *a*, - on side *b*. The gradient of the gap
    /// by vertex i is `signed_weights[i] * normal`.
    #[inline]
    pub fn signed_weights(&self, kind: PairKind) -> [f64; 4] {
        let [w0, w1, w2, w3] = self.weights;
        match kind {
            PairKind::EdgeEdge => [w0, w1, -w2, -w3],
            PairKind::VertexHalfSpace => [1.0, 0.0, 0.0, 0.0],
            _ => [w0, -w1, -w2, -w3],
        }
    }
}

/// Contact geometry of any pair kind but [`PairKind::VertexHalfSpace`]; unused points are ignored.
///
/// The normal is the direction of the closest points, unless its slab is narrower than 0.9 times their
/// distance and another direction certifies more: the face normal, the common normal of two edges, or the
/// direction between some of the pair's vertices and edges. (The slab is that narrow if the points are nearer
/// than about 1e-7 element sizes, where their difference is mostly rounding.) `weights` and `distance` are
/// always those of the closest points. Touching and intersecting pairs have `width <= 0` and the best
/// direction found. Finite input never gives not-a-number.
///
/// For [`PairKind::VertexHalfSpace`] the width is zero; see [`separate_half_space`].
#[inline]
pub fn separate(kind: PairKind, points: &[Point; 4]) -> Separation {
    let [p0, p1, p2, p3] = points;
    match kind {
        PairKind::VertexVertex => certify(kind, points, [p0 - p1]),
        PairKind::VertexEdge => certify(kind, points, [p0 - p1, p0 - p2]),
        PairKind::VertexTriangle => certify(kind, points, [p0 - p1, p0 - p2, p0 - p3]),
        PairKind::EdgeEdge => certify(kind, points, [p0 - p2, p0 - p3, p1 - p2, p1 - p3]),
        PairKind::VertexHalfSpace => undecided([1.0, 0.0, 0.0, 0.0]),
    }
}

/// Contact geometry of a vertex above a half-space.
///
/// `normal` is the normalized normal of the plane. `distance` is signed, negative inside the solid. `width`
/// is a lower bound of (n.x - offset)/|n| in exact arithmetic, for n and offset as they are stored.
pub fn separate_half_space(point: &Point, half_space: &HalfSpace) -> Separation {
    let weights = [1.0, 0.0, 0.0, 0.0];
    let HalfSpace { normal: n, offset } = half_space;
    let length = n.norm();
    // At most four factors 1 + e on each product and two on the offset, see the module; `magnitude` itself is
    // too small by at most four, hence 5 u. The length and the last two operations give relative errors of
    // the result: 2.5 u of the length, 1 u each of division and product, rounded up to 8 u. MIN_POSITIVE
    // covers underflow of the products.
    let value = n.dot(&point.coords) - offset;
    let magnitude = n.abs().dot(&point.coords.abs()) + offset.abs();
    let lowest = (value - (2.5 * f64::EPSILON * magnitude + f64::MIN_POSITIVE)) / length;
    let width = lowest - 4.0 * f64::EPSILON * lowest.abs();
    if !(length > 1e-150 && length < 1e150 && width.is_finite()) {
        return undecided(weights);
    }
    Separation { normal: n / length, weights, distance: value / length, width }
}

/// The result for a pair of which nothing can be certified.
fn undecided(weights: [f64; 4]) -> Separation {
    Separation { normal: Vector::z(), weights, distance: 0.0, width: 0.0 }
}

/// The certified separation, given the differences of all vertices of side *a* and all vertices of side *b*.
#[inline(always)]
fn certify<const N: usize>(kind: PairKind, points: &[Point; 4], differences: [Vector; N]) -> Separation {
    let scale = largest_coordinate(&differences);
    if !(scale > MIN_SCALE && scale < MAX_SCALE) {
        return separate_rescaled(kind, points);
    }
    let closest = distance::closest(kind, points);
    let slack = WIDTH_ROUNDING * scale;
    let mut separation = Separation {
        normal: Vector::z(),
        weights: closest.weights,
        distance: closest.distance,
        width: f64::NEG_INFINITY,
    };
    if let Some(normal) = unit(&closest.offset, closest.distance) {
        separation.normal = normal;
        separation.width = smallest_dot(&normal, &differences) - slack;
        if separation.width >= MIN_WIDTH_RATIO * closest.distance {
            return separation;
        }
    }
    try_other_directions(kind, points, &differences, slack, &mut separation);
    separation
}

/// Keeps the widest slab of all directions in which two features of the pair can face each other.
#[cold]
#[inline(never)]
fn try_other_directions(
    kind: PairKind,
    points: &[Point; 4],
    differences: &[Vector],
    slack: f64,
    separation: &mut Separation,
) {
    let mut slab = Slab { normal: separation.normal, width: separation.width };
    slab.try_directions(kind, points, differences, slack);
    slab.try_differences(differences, slack);
    (separation.normal, separation.width) = (slab.normal, slab.width);
}

/// [`separate`] for differences that are very small, very large or all zero.
#[cold]
#[inline(never)]
fn separate_rescaled(kind: PairKind, points: &[Point; 4]) -> Separation {
    let closest = distance::closest(kind, points);
    let Some(local) = Local::new(points, kind.vertex_count()) else {
        return undecided(closest.weights);
    };
    let [p0, p1, p2, p3] = &local.points;
    let differences = match kind {
        PairKind::VertexVertex => vec![p0 - p1],
        PairKind::VertexEdge => vec![p0 - p1, p0 - p2],
        PairKind::VertexTriangle => vec![p0 - p1, p0 - p2, p0 - p3],
        PairKind::EdgeEdge => vec![p0 - p2, p0 - p3, p1 - p2, p1 - p3],
        PairKind::VertexHalfSpace => return undecided(closest.weights),
    };
    let slack = MOVED_WIDTH_ROUNDING * largest_coordinate(&differences);
    let mut separation = Separation {
        normal: Vector::z(),
        weights: closest.weights,
        distance: closest.distance,
        width: f64::NEG_INFINITY,
    };
    try_other_directions(kind, &local.points, &differences, slack, &mut separation);
    // Unscaling may round if the width is subnormal.
    separation.width = local.unscale(separation.width).next_down();
    separation
}

#[cfg(test)]
mod tests;
