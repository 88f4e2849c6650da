//! Slabs between the vertices of two sides, with rounding taken into account as the parent module derives.

use crate::pair::PairKind;
use crate::point::{Point, Vector};

/// Bound of the rounding of a slab width, per largest coordinate difference; see the parent module.
pub(super) const WIDTH_ROUNDING: f64 = 10.0 * f64::EPSILON;

/// Bound of the rounding of a slab width of a pair that was moved to its first vertex: two more roundings of each difference, 2 u *
/// sqrt(3) m, before all others.
pub(super) const MOVED_WIDTH_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// If the width is below this part of the computed distance, other directions are tried.
pub(super) const MIN_WIDTH_RATIO: f64 = 0.9;

/// Largest absolute coordinate. Plain comparisons suffice, here and below: `f64::max` and `min` need more
/// instructions to treat not-a-number, which differences of finite numbers never are.
#[inline(always)]
pub(super) fn largest_coordinate(vectors: &[Vector]) -> f64 {
    let larger = |m: f64, x: f64| if m > x { m } else { x };
    let largest = vectors.iter().fold(Vector::zeros(), |m, d| m.zip_map(&d.abs(), larger));
    larger(larger(largest.x, largest.y), largest.z)
}

/// Smallest dot product.
#[inline(always)]
pub(super) fn smallest_dot(normal: &Vector, differences: &[Vector]) -> f64 {
    differences
        .iter()
        .map(|d| normal.dot(d))
        .fold(f64::INFINITY, |smallest, x| if smallest < x { smallest } else { x })
}

/// v / |v| with a length within 5 u of 1, given |v| as `distance::norm` computes it.
#[inline(always)]
pub(super) fn unit(v: &Vector, norm: f64) -> Option<Vector> {
    // Shorter vectors could overflow the reciprocal, and their squares have lost bits.
    if norm > 1e-140 && norm < f64::INFINITY { Some(v * (1.0 / norm)) } else { None }
}

/// The widest slab found so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slab {
    /// Unit direction from side *b* to side *a*.
    pub normal: Vector,
    /// Certified width [m].
    pub width: f64,
}

impl Slab {
    /// Tries every direction in which two features of a pair can face each other. `differences` are those of all
    /// vertices of the sides, which may have more vertices than the pair.
    pub fn try_directions(
        &mut self,
        kind: PairKind,
        points: &[Point; 4],
        differences: &[Vector],
        slack: f64,
    ) {
        let mut attempt = |direction: Vector| self.attempt(direction, differences, slack);
        let [p0, p1, p2, p3] = points;
        match kind {
            PairKind::VertexTriangle => {
                attempt(common_normal(&(p2 - p1), &(p3 - p1)));
                attempt(across(p0, [p1, p2]));
                attempt(across(p0, [p2, p3]));
                attempt(across(p0, [p3, p1]));
            }
            PairKind::EdgeEdge => {
                attempt(common_normal(&(p1 - p0), &(p3 - p2)));
                attempt(across(p0, [p2, p3]));
                attempt(across(p1, [p2, p3]));
                attempt(across(p2, [p0, p1]));
                attempt(across(p3, [p0, p1]));
            }
            PairKind::VertexEdge => attempt(across(p0, [p1, p2])),
            PairKind::VertexVertex | PairKind::VertexHalfSpace => {}
        }
    }

    /// Tries the directions between vertices.
    pub fn try_differences(&mut self, differences: &[Vector], slack: f64) {
        for d in differences {
            self.attempt(*d, differences, slack);
            // If all points are on one line, only this direction is perpendicular to it.
            self.attempt(d.cross(&Vector::ith(d.iamin(), 1.0)), differences, slack);
        }
        // All differences are zero or too short to normalize, so no direction was tried.
        if self.width == f64::NEG_INFINITY {
            self.width = -slack;
        }
    }

    /// Keeps the wider of the slab and those along a direction and its opposite.
    fn attempt(&mut self, direction: Vector, differences: &[Vector], slack: f64) {
        // Scaled first: a cross product of nearly parallel vectors may be very short.
        let Some(direction) = direction.try_normalize(0.0).filter(|d| d.iter().all(|x| x.is_finite())) else {
            return;
        };
        let Some(normal) = unit(&direction, direction.norm()) else { return };
        for normal in [normal, -normal] {
            let width = smallest_dot(&normal, differences) - slack;
            if width > self.width {
                *self = Self { normal, width };
            }
        }
    }
}

/// A vector perpendicular to both up to rounding, however nearly parallel they are. The part of v along u is
/// subtracted, because it would only add its rounding error to the cross product.
fn common_normal(u: &Vector, v: &Vector) -> Vector {
    u.cross(&(v - u * (u.dot(v) / u.norm_squared())))
}

/// The direction from an edge to a vertex, perpendicular to the edge up to rounding even if the vertex is
/// almost on the edge.
fn across(p: &Point, edge: [&Point; 2]) -> Vector {
    let along = edge[1] - edge[0];
    along.cross(&(p - edge[0]).cross(&along))
}
