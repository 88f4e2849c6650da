//! Two triangles: closest points, exact intersection, certified slab.
//!
//! The closest points of triangles that do not intersect are those of one of six vertex-triangle and nine
//! edge-edge pairs. Triangles that intersect have an edge of one that meets the other, which
//! [`intersection::triangle_triangle`] decides exactly. The slab is certified as for other pairs, over the
//! nine differences of their vertices.

use super::slab::{
    MIN_WIDTH_RATIO, MOVED_WIDTH_ROUNDING, Slab, WIDTH_ROUNDING, largest_coordinate, smallest_dot, unit,
};
use crate::distance::{self, Local, MAX_SCALE, MIN_SCALE};
use crate::intersection;
use crate::pair::PairKind;
use crate::point::{Point, Vector};

/// Distance of two triangles, with a certified lower bound; see [`triangle_triangle`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleSeparation {
    /// Whether the closed triangles share a point, decided exactly.
    pub intersect: bool,
    /// Unit direction (to rounding) from triangle *b* to triangle *a*. Where they intersect, it has no meaning.
    pub normal: Vector,
    /// Barycentric weights of the closest points over the vertices of *a* and of *b*, each in [0, 1]; those of a
    /// triangle sum to 1 up to rounding. Where the triangles intersect, those of a common point.
    pub weights: [[f64; 3]; 2],
    /// Computed distance of the closest points [m], off by at most 40 rounding units (2^-53) times the largest
    /// coordinate difference of the six vertices; 0 where the triangles intersect.
    pub distance: f64,
    /// Certified width of the slab between the triangles along `normal` [m]: at most the true distance. Where
    /// it is above 0, a plane with this normal separates them. It is never above 0 where they intersect.
    pub width: f64,
}

/// The part of a triangle that a closest point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TriangleFeature {
    /// A vertex, 0 to 2.
    Vertex(u8),
    /// An edge: 0 joins the vertices 0 and 1, 1 those 1 and 2, 2 those 2 and 0.
    Edge(u8),
    /// The inside.
    Face,
}

impl TriangleSeparation {
    /// The features of *a* and *b* that the closest points lie on: those whose vertices alone have weights.
    pub fn features(&self) -> [TriangleFeature; 2] {
        self.weights.map(|weights| match weights.map(|w| w > 0.0) {
            [true, false, false] => TriangleFeature::Vertex(0),
            [false, true, false] => TriangleFeature::Vertex(1),
            [false, false, true] => TriangleFeature::Vertex(2),
            [true, true, false] => TriangleFeature::Edge(0),
            [false, true, true] => TriangleFeature::Edge(1),
            [true, false, true] => TriangleFeature::Edge(2),
            _ => TriangleFeature::Face,
        })
    }
}

/// Distance of two closed triangles, either of which may have zero area: a segment is a triangle with two equal
/// vertices, a point one with three.
///
/// `width` comes from the direction of the closest points or, if that slab is narrower than 0.9 times their
/// distance, from the best of all directions in which features of the triangles can face each other. A width
/// above 0 proves that the triangles are apart; otherwise the exact test decides. It holds for coordinates that
/// are zero or between 1e-90 and 1e100 in magnitude, see [`crate::intersection`].
///
/// Finite coordinates never give not-a-number. With others the distance is not-a-number and the width 0.
///
/// ```
/// use bowknot_geometry::{Point, TriangleFeature, separation};
///
/// let a = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from);
/// let b = [[0.2, 0.2, 0.5], [0.2, 1.2, 0.9], [1.2, 0.2, 0.9]].map(Point::from);
/// let apart = separation::triangle_triangle(a.each_ref(), b.each_ref());
/// assert_eq!(apart.distance, 0.5);
/// assert!(!apart.intersect && apart.width <= 0.5 && apart.width > 0.499);
/// assert_eq!(apart.features(), [TriangleFeature::Face, TriangleFeature::Vertex(0)]);
///
/// let through = [[0.2, 0.2, -0.1], [0.2, 1.2, 0.9], [1.2, 0.2, 0.9]].map(Point::from);
/// let crossing = separation::triangle_triangle(a.each_ref(), through.each_ref());
/// assert!(crossing.intersect && crossing.distance == 0.0 && crossing.width <= 0.0);
/// ```
pub fn triangle_triangle(a: [&Point; 3], b: [&Point; 3]) -> TriangleSeparation {
    let points = [*a[0], *a[1], *a[2], *b[0], *b[1], *b[2]];
    let meet = || intersection::triangle_triangle(a, b);
    let first = [1.0, 0.0, 0.0];
    let unknown = TriangleSeparation {
        intersect: false,
        normal: Vector::z(),
        weights: [first, first],
        distance: f64::NAN,
        width: 0.0,
    };
    if !points.iter().all(|p| p.iter().all(|x| x.is_finite())) {
        return unknown;
    }
    let differences = differences(&points);
    let scale = largest_coordinate(&differences);
    if scale > MIN_SCALE && scale < MAX_SCALE {
        return separate(&points, &differences, WIDTH_ROUNDING * scale, meet);
    }
    let Some(local) = Local::new(&points, points.len()) else {
        return TriangleSeparation { intersect: true, distance: 0.0, ..unknown };
    };
    let differences = self::differences(&local.points);
    let slack = MOVED_WIDTH_ROUNDING * largest_coordinate(&differences);
    let scaled = separate(&local.points, &differences, slack, meet);
    // Unscaling may round if the width is subnormal.
    let width = local.unscale(scaled.width).next_down();
    TriangleSeparation { distance: local.unscale(scaled.distance), width, ..scaled }
}

/// All vertices of *a* minus all vertices of *b*.
#[inline(always)]
fn differences([a0, a1, a2, b0, b1, b2]: &[Point; 6]) -> [Vector; 9] {
    [a0 - b0, a0 - b1, a0 - b2, a1 - b0, a1 - b1, a1 - b2, a2 - b0, a2 - b1, a2 - b2]
}

/// The pairs of features, by their places among the six points. Those of a vertex of *b* and the triangle *a*
/// have their sides exchanged.
const PAIRS: [(PairKind, [usize; 4]); 15] = {
    const VT: PairKind = PairKind::VertexTriangle;
    const EE: PairKind = PairKind::EdgeEdge;
    [
        (VT, [0, 3, 4, 5]),
        (VT, [1, 3, 4, 5]),
        (VT, [2, 3, 4, 5]),
        (VT, [3, 0, 1, 2]),
        (VT, [4, 0, 1, 2]),
        (VT, [5, 0, 1, 2]),
        (EE, [0, 1, 3, 4]),
        (EE, [0, 1, 4, 5]),
        (EE, [0, 1, 5, 3]),
        (EE, [1, 2, 3, 4]),
        (EE, [1, 2, 4, 5]),
        (EE, [1, 2, 5, 3]),
        (EE, [2, 0, 3, 4]),
        (EE, [2, 0, 4, 5]),
        (EE, [2, 0, 5, 3]),
    ]
};

/// Multiple of the slack that a distance may exceed the certified width by and count as the least. The slack is 20
/// or 32 rounding units of the largest difference.
const NEAREST: f64 = 1.2;

/// The closest points so far.
#[derive(Clone, Copy)]
struct Nearest {
    /// Over the six points.
    weights: [f64; 6],
    distance: f64,
}

/// The separation of points at a scale that needs no care. `meet` tells whether the triangles intersect.
fn separate(
    points: &[Point; 6],
    differences: &[Vector; 9],
    slack: f64,
    meet: impl Fn() -> bool,
) -> TriangleSeparation {
    let mut nearest = Nearest { weights: [0.0; 6], distance: f64::INFINITY };
    let mut slab = Slab { normal: Vector::z(), width: f64::NEG_INFINITY };
    for (kind, places) in &PAIRS {
        let closest = distance::closest(*kind, &places.map(|place| points[place]));
        if closest.distance < nearest.distance {
            let exchanged = places[0] > 2;
            let offset = if exchanged { -closest.offset } else { closest.offset };
            nearest = Nearest { weights: [0.0; 6], distance: closest.distance };
            places.iter().zip(closest.weights).for_each(|(&place, w)| nearest.weights[place] = w);
            let normal = unit(&offset, closest.distance).unwrap_or(Vector::z());
            slab = Slab { normal, width: smallest_dot(&normal, differences) - slack };
            if closest.distance <= slab.width + NEAREST * slack {
                break;
            }
        }
    }
    let mut intersect = false;
    if slab.width < MIN_WIDTH_RATIO * nearest.distance {
        intersect = slab.width <= 0.0 && meet();
        if intersect {
            nearest = common_point(points, nearest);
        } else {
            try_all_directions(points, differences, slack, &mut slab);
        }
    }
    let [a0, a1, a2, b0, b1, b2] = nearest.weights;
    TriangleSeparation {
        intersect,
        normal: slab.normal,
        weights: [[a0, a1, a2], [b0, b1, b2]],
        distance: if intersect { 0.0 } else { nearest.distance },
        width: slab.width,
    }
}

/// Keeps the widest slab of all directions in which features of the triangles can face each other. Which of
/// the pairs is the closest may be decided by rounding, so those of all of them are tried.
#[cold]
#[inline(never)]
fn try_all_directions(points: &[Point; 6], differences: &[Vector; 9], slack: f64, slab: &mut Slab) {
    for (kind, places) in &PAIRS {
        slab.try_directions(*kind, &places.map(|place| points[place]), differences, slack);
    }
    slab.try_differences(differences, slack);
}

/// A common point of triangles that intersect: where an edge of one passes the plane of the other, or
/// `nearest`, the closest points of the pairs.
#[cold]
#[inline(never)]
fn common_point(points: &[Point; 6], mut nearest: Nearest) -> Nearest {
    for (edges_of, face) in [([0, 1, 2], [3, 4, 5]), ([3, 4, 5], [0, 1, 2])] {
        // Relative to a vertex, so that points far from the origin lose nothing.
        let triangle = face.map(|place: usize| Point::from(points[place] - points[face[0]]));
        let normal = triangle[1].coords.cross(&triangle[2].coords);
        for k in 0..3 {
            let (start, end) = (edges_of[k], edges_of[(k + 1) % 3]);
            let (p, q) = (points[start] - points[face[0]], points[end] - points[face[0]]);
            let (p_height, q_height) = (normal.dot(&p), normal.dot(&q));
            let t = p_height / (p_height - q_height);
            if !(0.0..=1.0).contains(&t) {
                continue;
            }
            let passage = Point::from(p + (points[end] - points[start]) * t);
            let closest = distance::vertex_triangle(&passage, triangle.each_ref());
            if closest.distance < nearest.distance {
                nearest = Nearest { weights: [0.0; 6], distance: closest.distance };
                (nearest.weights[start], nearest.weights[end]) = (1.0 - t, t);
                face.iter().zip(&closest.weights[1..]).for_each(|(&place, w)| nearest.weights[place] = *w);
            }
        }
    }
    nearest
}
