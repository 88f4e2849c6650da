//! How far each vertex may travel before the pairs must be searched again.

use bowknot_geometry::{Point, Vector};

/// Share of its radius that a vertex may use; the rest covers the rounding of the bound itself.
const USABLE: f64 = 1.0 - 1e-3;

/// The trust regions of the vertices: one ball per vertex, around its position at the last search.
///
/// The search leaves out a pair only if a certified lower bound of its distance exceeds the sum of the
/// largest radii of its two sides. As long as every vertex stays in its ball, such a pair cannot meet. The
/// balls themselves limit nothing:
/// [`Stepper::limit_by_trust_regions`](crate::Stepper::limit_by_trust_regions) does, and
/// [`Forward`](crate::Forward) always calls it.
#[derive(Clone, Debug, Default)]
pub struct TrustRegions {
    /// Centers: positions at the last search [m].
    pub centers: Vec<Point>,
    /// Radius of each ball, rho [m].
    pub radii: Vec<f64>,
}

impl TrustRegions {
    /// Largest alpha in [0, 1] with which vertex `v` stays in its ball, when it moves from `x` by alpha `d`.
    #[inline]
    pub fn limit(&self, v: usize, x: &Point, d: &Vector) -> f64 {
        let radius = USABLE * self.radii[v];
        let p = x - self.centers[v];
        if (p + d).norm_squared() <= radius * radius {
            return 1.0;
        }
        let dd = d.norm_squared();
        if dd == 0.0 {
            return 1.0;
        }
        // Larger root of |p + alpha d|^2 = radius^2, in the form without cancellation for each sign of p . d.
        let pd = p.dot(d);
        let room = (radius * radius - p.norm_squared()).max(0.0);
        let root = (pd * pd + dd * room).sqrt();
        let alpha = if pd > 0.0 { room / (root + pd) } else { (root - pd) / dd };
        if alpha.is_finite() { alpha.clamp(0.0, 1.0) } else { 0.0 }
    }
}
