//! The first triangle that a ray meets.
//!
//! A ray is a segment whose end lies beyond the mesh. [`intersection::edge_triangle`] decides exactly which
//! triangles this segment meets, so no ray slips through between two of them.
//!
//! **Rounding.** Boxes are tested in `f64`, relative to the local origin. With u = 2^-53, places along the
//! segment are off by 2 u times its coordinates, which `margin` covers. The place s where it enters a box is a
//! product of a difference and a reciprocal, hence off by 3 u of itself; `SLACK` covers that. The place of a hit
//! is limited to where the segment passes the box of the triangle. So a box that is left out has no hit that
//! comes before the best, and the result does not depend on the order of the tree.

use super::descend::{Placed, Probe, descend};
use crate::frame::MAX_COORDINATE;
use crate::min_max::{larger, smaller};
use crate::tree::{LANES, Node};
use bowknot_geometry::{Aabb, Point, Vector, distance, intersection};

/// Where a ray meets a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric weights of the point over the vertices of the triangle, each in [0, 1].
    pub weights: [f64; 3],
    /// Distance from the origin in units of the length of the direction [1].
    pub t: f64,
    /// The point of the triangle [m].
    pub point: Point,
}

/// Covers the rounding of places along the segment.
const SLACK: f64 = 1e-14;

/// Ratio of a triangle's height differences to lengths below which the segment counts as nearly in its plane.
const NEARLY_FLAT: f64 = 1e-12;

/// Smallest length of a segment as a share of the coordinates of its origin: rounding its end turns it by no
/// more than 1e-12.
const MIN_LENGTH: f64 = 1e-3;

/// A segment, with what box tests need.
struct Segment {
    start: Point,
    end: Point,
    /// The start in the local frame [m].
    local: Vector,
    /// One over the components of end - start, finite.
    inverse: [f64; 3],
    /// By how much boxes are inflated [m].
    margin: f64,
}

struct First<'a> {
    mesh: Placed<'a>,
    segment: Segment,
    /// The largest place of interest on the segment, in [0, 1] if there is a hit.
    place: f64,
    best: Option<(u32, [u32; 3])>,
}

/// See [`super::MeshQuery::cast_ray`].
pub fn cast_ray(mesh: Placed<'_>, origin: &Point, direction: &Vector, max: f64) -> Option<RayHit> {
    let local = origin - mesh.origin;
    let [low, high] = mesh.tree.bounds().map(|corner| Vector::from(corner.map(f64::from)));
    // An upper bound of the distance of the farthest point of the mesh.
    let farthest: f64 = (0..3).map(|k| (low[k] - local[k]).abs().max((high[k] - local[k]).abs())).sum();
    let length = 1.01 * farthest.max(MIN_LENGTH * origin.coords.amax());
    let largest = direction.amax();
    // t at the end of the segment, rounded up to a power of two so that t has no other rounding than the place. It
    // is not finite for a mesh without triangles, and not-a-number for a direction of length 0.
    let t_end = libm::exp2(libm::log2(length / (direction / largest).norm() / largest).ceil());
    if !(local.iter().all(|x| x.abs() < MAX_COORDINATE) && t_end.is_finite() && max >= 0.0) {
        return None;
    }
    let segment = Segment::new(*origin, origin + direction * t_end, local);
    let mut first = First { mesh, segment, place: max / t_end, best: None };
    descend(mesh.tree, &mut first);
    let (triangle, vertices) = first.best?;
    let corners = mesh.corners(vertices);
    let met = first.segment.at(first.place);
    let [_, w0, w1, w2] = distance::vertex_triangle(&met, corners).weights;
    let point = Point::from(corners[0].coords * w0 + corners[1].coords * w1 + corners[2].coords * w2);
    Some(RayHit { triangle, weights: [w0, w1, w2], t: first.place * t_end, point })
}

impl Segment {
    fn new(start: Point, end: Point, local: Vector) -> Self {
        let along = end - start;
        // A component of zero leaves only the sign of a difference.
        let inverse = [0, 1, 2].map(|k: usize| {
            let size = along[k].abs().max(1e-200);
            if along[k] < 0.0 { -1.0 / size } else { 1.0 / size }
        });
        Self { start, end, local, inverse, margin: 4.0 * f64::EPSILON * (local.amax() + along.amax()) }
    }

    fn at(&self, place: f64) -> Point {
        self.start + (self.end - self.start) * place
    }

    /// The places where the segment enters and leaves the slab of one axis between two local coordinates.
    #[inline(always)]
    fn passage(&self, k: usize, low: f64, high: f64) -> [f64; 2] {
        let inverse = self.inverse[k];
        let below = ((low - self.margin) - self.local[k]) * inverse;
        let above = ((high + self.margin) - self.local[k]) * inverse;
        if inverse > 0.0 { [below, above] } else { [above, below] }
    }
}

impl First<'_> {
    /// The place on the segment at which it meets a triangle that it meets.
    fn place_on(&self, corners: [&Point; 3]) -> f64 {
        let Segment { start, end, .. } = &self.segment;
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a));
        let (from_start, from_end) = (start - a, end - a);
        let heights = [normal.dot(&from_start), normal.dot(&from_end)];
        let drop = heights[0] - heights[1];
        let mut place = heights[0] / drop;
        let crosses = drop.abs() > NEARLY_FLAT * normal.norm() * (from_start.norm() + from_end.norm());
        if !crosses {
            place = self.first_place_in_plane(corners).unwrap_or(place);
        }
        // Of the triangle's own box: a part of those in the tree.
        let own = Aabb::of_points(corners);
        let (low, high) = (own.min - self.mesh.origin, own.max - self.mesh.origin);
        let passages = [0, 1, 2].map(|k: usize| self.segment.passage(k, low[k], high[k]));
        let [near, far] =
            passages.iter().fold([0.0, 1.0], |[near, far], p| [larger(near, p[0]), smaller(far, p[1])]);
        larger(smaller(place, far), near)
    }

    /// The first place at which the segment, in the plane of a triangle, meets the start, a side or a vertex.
    fn first_place_in_plane(&self, corners: [&Point; 3]) -> Option<f64> {
        let Segment { start, end, .. } = &self.segment;
        if intersection::point_on_triangle(start, corners) {
            return Some(0.0);
        }
        let [a, b, c] = corners;
        let sides =
            [[a, b], [b, c], [c, a]].into_iter().filter(|side| intersection::edge_edge([start, end], *side));
        let at_sides = sides.map(|side| distance::edge_edge([start, end], side).weights[1]);
        // Where a side lies along the segment.
        let vertices = corners.into_iter().filter(|v| intersection::point_on_edge(v, [start, end]));
        let at_vertices = vertices.map(|v| distance::vertex_edge(v, [start, end]).weights[2]);
        at_sides.chain(at_vertices).reduce(f64::min)
    }
}

impl Probe for First<'_> {
    #[inline(always)]
    fn bounds(&self, node: &Node) -> [f64; LANES] {
        let (mut near, mut far) = ([0.0; LANES], [1.0; LANES]);
        for k in 0..3 {
            for lane in 0..LANES {
                let (low, high) = (f64::from(node.low[k][lane]), f64::from(node.high[k][lane]));
                let [enters, leaves] = self.segment.passage(k, low, high);
                near[lane] = larger(near[lane], enters);
                far[lane] = smaller(far[lane], leaves);
            }
        }
        let mut bounds = near;
        for lane in 0..LANES {
            let is_met = near[lane] * (1.0 - SLACK) <= far[lane] * (1.0 + SLACK);
            bounds[lane] = if is_met { near[lane] * (1.0 - SLACK) } else { f64::INFINITY };
        }
        bounds
    }

    fn limit(&self) -> f64 {
        self.place
    }

    fn visit(&mut self, triangle: u32, vertices: [u32; 3]) {
        let corners = self.mesh.corners(vertices);
        if !intersection::edge_triangle([&self.segment.start, &self.segment.end], corners) {
            return;
        }
        let place = self.place_on(corners);
        let is_better = match self.best {
            None => place <= self.place,
            Some((best, _)) => place < self.place || (place == self.place && triangle < best),
        };
        if is_better {
            (self.place, self.best) = (place, Some((triangle, vertices)));
        }
    }
}
