//! How far each vertex may travel before the pairs must be searched again.

use bowknot_geometry::{Point, Vector};

/// Share of its budget that a vertex may really use; the rest covers rounding of the bound itself.
const USABLE: f64 = 1.0 - 1e-3;

/// The ball around its place at the last search in which each vertex stays.
///
/// A pair that the search left out has, by a certified lower bound, a distance above the sum of its sides'
/// largest budgets; as long as every vertex stays in its ball, such a pair cannot meet.
#[derive(Clone, Debug, Default)]
pub struct Budgets {
    /// Places at the last search [m].
    pub anchors: Vec<Point>,
    /// Radius of each ball, rho [m].
    pub radii: Vec<f64>,
}

impl Budgets {
    /// Radius of the ball in which a vertex can go by `travel` [m] and arrive.
    pub fn radius_for(travel: f64) -> f64 {
        // As much again for the rounding of positions within the ball.
        travel / (USABLE - (1.0 - USABLE))
    }

    /// Largest alpha in [0, 1] with which vertex `v` at `x`, wanting to move by `d`, stays in its ball.
    #[inline]
    pub fn limit(&self, v: usize, x: &Point, d: &Vector) -> f64 {
        let radius = USABLE * self.radii[v];
        let p = x - self.anchors[v];
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
