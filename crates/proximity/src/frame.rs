//! Positions relative to a local origin, in `f32`.
//!
//! Boxes and the first distance test work on `f32`, whose rounding grows with the coordinates: so
//! they are taken relative to an origin near the deformable vertices. The origin is a function of
//! the positions alone, never of earlier searches, because it decides (by rounding) which pairs are
//! dropped, and the same input shall give the same pairs. It sits on a coarse grid so that it stays
//! where it is while things move, and the trees of obstacles at rest stay valid.

use bowknot_geometry::{Point, Vector};

/// Half a rounding step of `f32` relative to 1: the relative error of one operation.
pub const UNIT: f32 = f32::EPSILON / 2.0;

/// Coordinates beyond this [m] are treated as not finite: their squares would overflow.
const REACH: f64 = 1e15;

/// A vertex in the local frame: offset from the origin and radius [m]. All four are not-a-number
/// where the input is not finite; such vertices, and elements with them, are in no pair.
pub type LocalVertex = [f32; 4];

/// The origin of a frame: the centre of the box of `vertices`, rounded to a grid as coarse as the
/// box is large.
pub fn origin(positions: &[Point], vertices: &[u32]) -> Point {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &v in vertices {
        let p = &positions[v as usize];
        // Not-a-number fails the comparison too.
        if p.x.abs() < REACH && p.y.abs() < REACH && p.z.abs() < REACH {
            for k in 0..3 {
                low[k] = if p[k] < low[k] { p[k] } else { low[k] };
                high[k] = if p[k] > high[k] { p[k] } else { high[k] };
            }
        }
    }
    // No grid finer than a few centimetres: a lone particle would change it all the time.
    let extent = (0..3).fold(0.06, |e: f64, k| e.max(high[k] - low[k]));
    let grid = extent.log2().ceil().exp2();
    let centre =
        |k: usize| if low[k] <= high[k] { (0.5 * (low[k] + high[k]) / grid).round() * grid } else { 0.0 };
    Point::new(centre(0), centre(1), centre(2))
}

/// A vertex in the frame of `origin`.
///
/// With u = [`UNIT`], each coordinate is off by at most u times itself (and an `f64` rounding far
/// below that), the radius too.
#[inline(always)]
pub fn localize(position: &Point, displacement: &Vector, radius: f64, origin: &Point) -> LocalVertex {
    let x = (position.x + displacement.x) - origin.x;
    let y = (position.y + displacement.y) - origin.y;
    let z = (position.z + displacement.z) - origin.z;
    let inside = x.abs() < REACH && y.abs() < REACH && z.abs() < REACH && radius < REACH;
    if inside { [x as f32, y as f32, z as f32, radius as f32] } else { [f32::NAN; 4] }
}
