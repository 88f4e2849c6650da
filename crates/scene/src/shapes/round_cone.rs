//! Solids of round cones: limbs, fingers, noses.
//!
//! Each part is a round cone, the hull of two balls. The distances to the parts are joined by a smooth
//! minimum. Distances have slope 1 at most and the smooth minimum is a mean of theirs, so the field has too:
//! its value outside never exceeds the distance to the surface.

use super::isosurface::{self, Isosurface};
use super::mesh::TriangleMesh;
use bowknot_geometry::{Point, Vector};

/// The hull of two balls, neither of which contains the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundCone {
    /// Centers of the balls [m], farther apart than the radii differ.
    pub ends: [Point; 2],
    /// Radii of the balls [m].
    pub radii: [f64; 2],
    /// Width over which it blends into the parts before it [m], above 0.
    pub blend: f64,
}

impl RoundCone {
    /// Signed distance [m], negative inside (Quilez, "Round cone - distance", 2018).
    pub fn distance(&self, p: &Point) -> f64 {
        let [r0, r1] = self.radii;
        let (axis, from) = (self.ends[1] - self.ends[0], p - self.ends[0]);
        let length2 = axis.norm_squared();
        let taper = r0 - r1;
        let (y, z) = (from.dot(&axis), from.dot(&axis) - length2);
        let x2 = (from * length2 - axis * y).norm_squared();
        let (y2, z2) = (y * y * length2, z * z * length2);
        let slope2 = length2 - taper * taper;
        let k = taper.signum() * taper * taper * x2;
        if z.signum() * slope2 * z2 > k {
            (x2 + z2).sqrt() / length2 - r1
        } else if y.signum() * slope2 * y2 < k {
            (x2 + y2).sqrt() / length2 - r0
        } else {
            ((x2 * slope2 / length2).sqrt() + y * taper) / length2 - r0
        }
    }
}

/// A solid of round cones, each blended into those before it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoundCones {
    /// The parts; their order matters where three or more blend.
    pub parts: Vec<RoundCone>,
}

impl RoundCones {
    /// The field of the solid [m]: negative inside, 0 on the surface, of slope 1 at most.
    pub fn field(&self, p: &Point) -> f64 {
        smooth_union(&self.parts, p)
    }

    /// A box that contains the solid [m].
    pub fn bounds(&self) -> (Point, Point) {
        let mut parts = self.parts.iter().map(bounds);
        let first = parts.next().unwrap_or((Point::origin(), Point::origin()));
        parts.fold(first, |(low, high), (a, b)| (low.inf(&a), high.sup(&b)))
    }

    /// The surface: closed, of triangles of nearly equal size with edges of about `edge` [m]. Parts should be
    /// some edges thick, and the gaps between them some edges wide.
    pub fn mesh(&self, edge: f64) -> TriangleMesh {
        let (low, high) = self.bounds();
        let surface = Isosurface { field: |p: &Point| self.field(p), low, high };
        // Edges come out shorter than the spacing of the grid by a tenth.
        isosurface::mesh(&surface, 1.1 * edge)
    }
}

/// The field of round cones [m], each blended into those before it.
pub(super) fn smooth_union<'a>(parts: impl IntoIterator<Item = &'a RoundCone>, p: &Point) -> f64 {
    parts.into_iter().fold(f64::INFINITY, |field, part| {
        let distance = part.distance(p);
        if field.is_finite() { smooth_min(field, distance, part.blend) } else { distance }
    })
}

/// A box that contains a part with its blend [m].
pub(super) fn bounds(part: &RoundCone) -> (Point, Point) {
    let margin = Vector::repeat(part.radii[0].max(part.radii[1]) + part.blend);
    let [a, b] = part.ends;
    (a.inf(&b) - margin, a.sup(&b) + margin)
}

/// Minimum, rounded where the two differ by less than `blend`; of slope 1 at most, if both are.
fn smooth_min(a: f64, b: f64, blend: f64) -> f64 {
    let h = (blend - (a - b).abs()).max(0.0);
    a.min(b) - h * h / (4.0 * blend)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowknot_geometry::{Topology, check_mesh};

    /// A hand of two fingers.
    fn hand() -> RoundCones {
        let part = |ends: [[f64; 3]; 2], radius: f64, blend: f64| RoundCone {
            ends: ends.map(Point::from),
            radii: [radius, 0.9 * radius],
            blend,
        };
        let parts = vec![
            part([[0.0, -0.03, 0.0], [0.0, 0.03, 0.0]], 0.03, 0.01),
            part([[0.0, -0.03, 0.0], [0.1, -0.035, 0.0]], 0.02, 0.01),
            part([[0.0, 0.03, 0.0], [0.1, 0.035, 0.0]], 0.02, 0.01),
        ];
        RoundCones { parts }
    }

    #[test]
    fn the_mesh_is_one_closed_surface_on_the_zero_set() {
        let hand = hand();
        let mesh = hand.mesh(0.01);
        assert_eq!(check_mesh(&mesh.positions, &mesh.triangles), []);
        let topology = Topology::builder(mesh.positions.len())
            .triangles(mesh.triangles.clone())
            .build()
            .expect("topology");
        let (vertices, edges, triangles) =
            (mesh.positions.len() as i64, topology.edges.len() as i64, mesh.triangles.len() as i64);
        assert_eq!((vertices - edges + triangles, 2 * edges), (2, 3 * triangles));
        let farthest = mesh.positions.iter().map(|p| hand.field(p).abs()).fold(0.0, f64::max);
        assert!(farthest < 2e-4, "{farthest} m");
        // The gap between the fingers is open.
        assert!(mesh.positions.iter().all(|p| p.x < 0.05 || p.y.abs() > 0.01));
    }

    #[test]
    fn the_bounds_contain_the_solid() {
        let (low, high) = hand().bounds();
        assert!(hand().mesh(0.01).positions.iter().all(|p| low.inf(p) == low && high.sup(p) == high));
        assert_eq!(RoundCones::default().bounds(), (Point::origin(), Point::origin()));
    }
}
