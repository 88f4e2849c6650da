//! Parameters of the forward step and of the search radii.

use serde::{Deserialize, Serialize};

/// Parameters of the forward step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StepperParams {
    /// Which bound limits the vertices. Default planes.
    pub bound: Bound,
    /// Share of a pair's gap that one step may use up, the paper's gamma. Nearer to 1: longer steps that
    /// leave tighter gaps. Default 0.9.
    pub damping: f64,
    /// Gap [m] below which no step closes a pair further, xi. Default a tenth of `delta`; 0 switches it
    /// off (the floor is then the rounding bound alone). Refused below 16 ulp of the largest coordinate.
    pub floor: Option<f64>,
    /// How far vertices may travel between searches.
    pub budget: Budget,
    /// Smallest search radius: in edge lengths for `per-vertex` (default 0.1; smaller
    /// ones make contacts flicker), in `delta` for `uniform`
    /// (D_min/2; paper: 2 delta / 2).
    pub budget_min: f64,
    /// Largest search radius, likewise (default 0.25; larger ones multiply pairs; paper: D_max/2 = 4 delta / 2).
    pub budget_max: f64,
    /// Travel wanted, in mean edge lengths, above which the search follows the vertices along their
    /// paths on a common clock, as long as no contact pushes. Larger: more steps in free flight. `inf` switches it off. Default 0.6.
    pub swept_travel: f64,
}

/// The bound that keeps steps safe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// Half of the nearest distance, whatever the direction (paper, Eq. 18-20).
    Isotropic,
    /// Each side stays on its side of a certified separating slab; only closing motion is limited.
    Planes,
}

/// The rule for the distance that vertices may travel between searches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Budget {
    /// One distance for all vertices: search again when the fastest has used it up (paper, Algorithm 1).
    Uniform,
    /// One ball a vertex, as large as the travel it wants.
    PerVertex,
}

impl Default for StepperParams {
    fn default() -> Self {
        Self {
            bound: Bound::Planes,
            damping: 0.9,
            floor: None,
            budget: Budget::PerVertex,
            budget_min: 0.1,
            budget_max: 0.25,
            swept_travel: 0.6,
        }
    }
}

impl StepperParams {
    /// As the paper has it.
    pub fn paper() -> Self {
        Self {
            bound: Bound::Isotropic,
            floor: Some(0.0),
            budget: Budget::Uniform,
            budget_min: 1.0,
            budget_max: 2.0,
            swept_travel: f64::INFINITY,
            ..Self::default()
        }
    }

    /// Appends a line for each field out of its range.
    pub fn validate(&self, problems: &mut Vec<String>) {
        let mut check = |ok: bool, message: String| {
            if !ok {
                problems.push(message);
            }
        };
        check(
            self.damping > 0.0 && self.damping < 1.0,
            format!("stepper.damping = {} must lie between 0 and 1", self.damping),
        );
        if let Some(floor) = self.floor {
            check(
                floor.is_finite() && floor >= 0.0,
                format!("stepper.floor = {floor} must be finite and at least 0"),
            );
        }
        check(
            self.budget_min.is_finite() && self.budget_min > 0.0,
            format!("stepper.budget_min = {} must be finite and above 0", self.budget_min),
        );
        check(
            self.budget_max.is_finite() && self.budget_max >= self.budget_min,
            format!(
                "stepper.budget_max = {} must be finite and at least stepper.budget_min",
                self.budget_max
            ),
        );
        check(
            self.swept_travel > 0.0,
            format!("stepper.swept_travel = {} must be above 0", self.swept_travel),
        );
    }
}
