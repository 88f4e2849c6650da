//! A half-space: an analytic obstacle.

use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Vector;
use serde::{Deserialize, Serialize};

/// Everything below the plane through the obstacle's `translate`: an analytic obstacle without mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HalfSpaceShape {
    /// Direction out of the solid [1], of any length but zero. Default (0, 0, 1).
    pub normal: Vector,
}

impl Default for HalfSpaceShape {
    fn default() -> Self {
        Self { normal: Vector::z() }
    }
}

impl Parameters for HalfSpaceShape {
    fn check(&self, checks: &mut Checks) {
        let fits = self.normal.iter().all(|c| c.is_finite()) && self.normal.norm() > 0.0;
        let normal = format!("{:?}", self.normal.as_slice());
        checks.require(fits, "normal", normal, "must be finite and not zero");
    }
}
