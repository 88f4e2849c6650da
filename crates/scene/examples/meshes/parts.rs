//! Short ways to write round cones.

use bowknot_scene::geometry::Point;
use bowknot_scene::shapes::RoundCone;

/// One part.
pub fn part(ends: [[f64; 3]; 2], radii: [f64; 2], blend: f64) -> RoundCone {
    RoundCone { ends: ends.map(Point::from), radii, blend }
}

/// A part from the mirror image of its end to the end.
pub fn bar([x, y, z]: [f64; 3], radius: f64, blend: f64) -> RoundCone {
    part([[x, -y, z], [x, y, z]], [radius; 2], blend)
}

/// A part of the left side, where y is positive, and its mirror image.
pub fn pair(ends: [[f64; 3]; 2], radii: [f64; 2], blend: f64) -> [RoundCone; 2] {
    [part(ends, radii, blend), part(ends.map(|[x, y, z]| [x, -y, z]), radii, blend)]
}
