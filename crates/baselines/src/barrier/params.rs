//! Parameters of the log barrier.

use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::{CollisionScene, ResolveError};
use serde::{Deserialize, Serialize};

/// Parameters of [`super::Objective`] and of the methods that minimise it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BarrierParams {
    /// Strength k of the barrier [kg/s^2] (paper, Eq. 8). Larger: wider gaps, and a barrier that outweighs the way to the
    /// target; smaller: tighter gaps and shorter steps. Default 20, the paper's.
    pub strength: f64,
    /// Distance d at which the barrier sets in [m]. Default delta; the paper has 1 mm for both. Like delta it is lowered for
    /// neighbours in fine meshes, and scaled by the bodies' own contact distances.
    pub range: Option<f64>,
    /// Time step of the inertia term [s] for calls that state none. Default 1/100.
    pub time_step: f64,
    /// Stiffness [kg/s^2] of a penalty 1/2 k_e max(|e| - L, 0)^2 on edges longer than their limit L in a call. The paper's
    /// Eq. 7 has nothing of the kind, so that edges stretch: default 0, which switches it off.
    pub edge_stiffness: f64,
    /// What a descent step is scaled by. Default blocks.
    pub scaling: Scaling,
    /// A method stops once its step would move no vertex further than this, in mean edge lengths; Newton's method, once the
    /// decrement is below it. Default 1e-3.
    pub tolerance: f64,
}

/// What the gradient is multiplied by to make a descent step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scaling {
    /// dt^2/m of each vertex, the inverse of the inertia term: gradient descent in the metric of the objective (paper,
    /// section 3.4), y = x - (x - y0) - dt^2/m dB/dx.
    Mass,
    /// The inverse of each vertex's 3x3 block of a matrix that majorises the Hessian's convex part.
    Blocks,
}

impl Default for BarrierParams {
    fn default() -> Self {
        Self {
            strength: 20.0,
            range: None,
            time_step: 0.01,
            edge_stiffness: 0.0,
            scaling: Scaling::Blocks,
            tolerance: 1e-3,
        }
    }
}

impl BarrierParams {
    /// Checks every field, also against the scene: pairs within the barrier's range must be candidates.
    ///
    /// # Errors
    /// [`ResolveError::Params`] with an error for each field out of its range.
    pub fn validate_for(&self, scene: &CollisionScene) -> Result<(), ResolveError> {
        let mut checks = Checks::default();
        checks.within("barrier", self);
        let largest = scene.lengths().contact_range;
        if let Some(range) = self.range {
            let allowed =
                format!("must be at most contact.range times delta = {largest} m, or pairs are missed");
            // The check above refuses NaN.
            checks.require(range.is_nan() || range <= largest, "barrier.range", range, allowed);
        }
        checks.finish().map_err(ResolveError::Params)
    }
}

impl Parameters for BarrierParams {
    fn check(&self, checks: &mut Checks) {
        checks.positive("strength", self.strength);
        if let Some(range) = self.range {
            checks.positive("range", range);
        }
        checks.positive("time_step", self.time_step);
        checks.non_negative("edge_stiffness", self.edge_stiffness);
        checks.positive("tolerance", self.tolerance);
    }
}
