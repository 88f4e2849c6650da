//! The point of a mesh that is closest to a given one.
//!
//! **Why the result depends on the input alone.** It is the triangle of least computed distance, of equals the
//! first, whatever the order of the tree. A box is left out only if its bound exceeds the least distance so far.
//! The bound is below the true distance of every triangle in the box by at least 4 u m + u d, with u = 2^-24,
//! the largest local coordinate m of the triangle and the bound d: the boxes are that much too large (see
//! `tree.rs`), and `SHRINK` takes 8 u of the square, of which rounding may use 6 u. That is far more than the
//! error of a computed distance, 8 * 2^-53 of the pair's size. So a triangle that is left out has a larger
//! computed distance.

use super::descend::{Placed, Probe, descend};
use super::local_point::local_box;
use crate::frame::UNIT_ROUNDOFF;
use crate::min_max::larger;
use crate::tree::{LANES, Node};
use bowknot_geometry::{Point, distance};

/// A point on a triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Index of the triangle.
    pub triangle: u32,
    /// Barycentric weights of the point over the vertices of the triangle, each in [0, 1].
    pub weights: [f64; 3],
    /// The point [m].
    pub point: Point,
    /// Its distance from the given point [m].
    pub distance: f64,
}

/// Covers the rounding of a squared distance of boxes.
const SHRINK: f32 = 1.0 - 8.0 * UNIT_ROUNDOFF;

struct Nearest<'a> {
    mesh: Placed<'a>,
    point: Point,
    /// A box around the point, in the local frame.
    low: [f32; 3],
    high: [f32; 3],
    /// The largest distance of interest, and its square, rounded up.
    distance: f64,
    squared: f64,
    best: Option<(u32, [u32; 3], [f64; 3])>,
}

/// See [`super::MeshQuery::closest_point`].
pub fn closest_point(mesh: Placed<'_>, point: &Point, max_distance: f64) -> Option<SurfacePoint> {
    let [low, high] = local_box(point, &mesh.origin)?;
    let squared = square_up(max_distance);
    let mut nearest = Nearest { mesh, point: *point, low, high, distance: max_distance, squared, best: None };
    descend(mesh.tree, &mut nearest);
    let (triangle, vertices, weights) = nearest.best?;
    let corners = mesh.corners(vertices);
    let point = Point::from((0..3).map(|k| corners[k].coords * weights[k]).sum::<bowknot_geometry::Vector>());
    Some(SurfacePoint { triangle, weights, point, distance: nearest.distance })
}

/// The square of a number, rounded up. Squares below 1e-300 need not be exact: bounds below that are negative.
fn square_up(x: f64) -> f64 {
    x * x * (1.0 + 4.0 * f64::EPSILON)
}

impl Probe for Nearest<'_> {
    #[inline(always)]
    fn bounds(&self, node: &Node) -> [f64; LANES] {
        let mut squared = [0.0; LANES];
        for k in 0..3 {
            for lane in 0..LANES {
                let gap = larger(node.low[k][lane] - self.high[k], self.low[k] - node.high[k][lane]);
                let gap = larger(gap, 0.0);
                squared[lane] += gap * gap;
            }
        }
        // The smallest normal number covers underflow of the squares.
        squared.map(|squared: f32| f64::from(squared * SHRINK - f32::MIN_POSITIVE))
    }

    #[inline(always)]
    fn limit(&self) -> f64 {
        self.squared
    }

    #[inline(always)]
    fn visit(&mut self, triangle: u32, vertices: [u32; 3]) {
        let closest = distance::vertex_triangle(&self.point, self.mesh.corners(vertices));
        let is_better = match self.best {
            None => closest.distance <= self.distance,
            Some((best, ..)) => {
                closest.distance < self.distance || (closest.distance == self.distance && triangle < best)
            }
        };
        if is_better {
            let [_, w0, w1, w2] = closest.weights;
            self.best = Some((triangle, vertices, [w0, w1, w2]));
            (self.distance, self.squared) = (closest.distance, square_up(closest.distance));
        }
    }
}
