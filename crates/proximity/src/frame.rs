//! Positions relative to a local origin, in `f32`.
//!
//! Boxes and the first distance test use `f32`. Its rounding error grows with the coordinates, so coordinates
//! are taken relative to an origin near the deformable vertices. The origin affects, by rounding, which pairs
//! are dropped, and the same input must give the same pairs. So it is a function of the positions alone, not
//! of earlier searches. It lies on a coarse grid and rarely changes while vertices move, so the trees of
//! obstacles at rest stay valid.

use bowknot_geometry::{Point, Vector};

/// Unit roundoff of `f32`: the largest relative error of one operation.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// Coordinates beyond this [m] are treated as not finite: their squares would overflow.
pub const MAX_COORDINATE: f64 = 1e15;

/// A vertex in the local frame: offset from the origin and radius [m]. All four are not-a-number if the input
/// is not finite; such vertices, and elements with them, are in no pair.
pub type LocalVertex = [f32; 4];

/// The origin of a frame: the center of the box of `vertices`, rounded to a grid about as coarse as the box
/// is large.
pub fn origin(positions: &[Point], vertices: &[u32]) -> Point {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &v in vertices {
        let p = &positions[v as usize];
        // Not-a-number fails the comparison too.
        if p.x.abs() < MAX_COORDINATE && p.y.abs() < MAX_COORDINATE && p.z.abs() < MAX_COORDINATE {
            for k in 0..3 {
                low[k] = if p[k] < low[k] { p[k] } else { low[k] };
                high[k] = if p[k] > high[k] { p[k] } else { high[k] };
            }
        }
    }
    // The grid is at least a few centimeters wide; with a finer one a lone particle would change the origin
    // all the time.
    let extent = (0..3).fold(0.06, |e: f64, k| e.max(high[k] - low[k]));
    let grid = libm::exp2(libm::log2(extent).ceil());
    let center =
        |k: usize| if low[k] <= high[k] { (0.5 * (low[k] + high[k]) / grid).round() * grid } else { 0.0 };
    Point::new(center(0), center(1), center(2))
}

/// A vertex in the frame of `origin`.
///
/// With u = [`UNIT_ROUNDOFF`], each coordinate and the radius are off by at most u times themselves (and an
/// `f64` rounding error far below that).
#[inline(always)]
pub fn localize(position: &Point, displacement: &Vector, radius: f64, origin: &Point) -> LocalVertex {
    let x = (position.x + displacement.x) - origin.x;
    let y = (position.y + displacement.y) - origin.y;
    let z = (position.z + displacement.z) - origin.z;
    let inside = x.abs() < MAX_COORDINATE
        && y.abs() < MAX_COORDINATE
        && z.abs() < MAX_COORDINATE
        && radius < MAX_COORDINATE;
    if inside { [x as f32, y as f32, z as f32, radius as f32] } else { [f32::NAN; 4] }
}
