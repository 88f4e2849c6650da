//! Parameters of the two-way method: one struct, every switch its own field, two presets.

use bowknot_constraints::ConstraintParams;
use bowknot_stepper::StepperParams;
use serde::{Deserialize, Serialize};

/// Parameters of [`crate::Resolver`]. `Params::default()` is [`Params::fast`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Params {
    /// Contact and edge-length constraints.
    pub constraints: ConstraintParams,
    /// The backward step.
    pub backward: BackwardParams,
    /// The forward step and the search radii that feed it.
    pub stepper: StepperParams,
    /// When to stop.
    pub stop: StopParams,
}

/// Parameters of the backward step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BackwardParams {
    /// Gauss-Seidel sweeps per backward step. More: a better target, dearer steps. Default 8 (paper: 1).
    pub sweeps: usize,
    /// Sweeps allowed once the remaining distance is below `polish_distance`, while the target
    /// stretches edges beyond the limit by more than half of `stop.stretch_tolerance`. Default 64.
    pub polish_sweeps: usize,
    /// Remaining distance below which `polish_sweeps` applies, in local edge lengths. Default 1.
    pub polish_distance: f64,
    /// Strength of the proximal term on edges: mu_i += edge_proximal * sum lambda_e / |e|. 0 switches it off; smaller
    /// ones come nearer to the true projection until edges wander (linear form: 2). Default 0.1.
    pub edge_proximal: f64,
    /// Strength of the proximal term on contacts: mu_i += contact_proximal * sum lambda_p |g| / r, r the length that the
    /// contact's normal turns with: that of edges, or the distance where vertices or parallel edges meet. Default 0.1.
    pub contact_proximal: f64,
    /// Largest factor on the proximal term of a vertex: it doubles each time that the way the vertex wants turns back
    /// from one step to the next, and falls slowly otherwise. 1: the term stays as it is. Default 32.
    pub proximal_growth: f64,
    /// Whether one scalar for all multipliers is solved for before each sweep. Default true.
    pub coarse_correction: bool,
    /// Whether rows that are neither pushing nor predicted to close are left out of the sweeps. Default true.
    pub active_rows: bool,
}

/// When the loop stops.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StopParams {
    /// Largest number of two-way steps, the paper's L. The default follows the time step: 512 up to
    /// dt = 1/100, 2048 at 1/20 and above, in proportion to dt between. A simulation that goes on with another Newton iteration
    /// ends the stage before it after 128 steps.
    pub max_steps: Option<usize>,
    /// Largest wall time of one call [s]; none by default.
    pub max_seconds: Option<f64>,
    /// The rule.
    pub rule: StopRule,
    /// `StopRule::Travel`: largest distance not travelled, in mean edge lengths. Default 0.01.
    pub distance: f64,
    /// `StopRule::Travel`: largest distance, in mean edge lengths, of a body as a whole from where the forces on it
    /// balance. Default 0.2.
    pub imbalance: f64,
    /// `StopRule::Travel`: largest mean over a body's vertices of how far each is from where the forces on it balance, in
    /// mean edge lengths, for as long as each step still takes off half of it. What the proximal term holds
    /// back acts like a drag on all that slides; this bounds it. Smaller: one or two steps more a call. The
    /// default is 1e-4.
    pub drag: Option<f64>,
    /// `StopRule::Travel`: how far the stretch limits may be exceeded, relative. Default 0.02.
    pub stretch_tolerance: f64,
    /// `StopRule::Clock`: the paper's epsilon. Default 1e-4.
    pub clock: f64,
}

/// Which quantity stops the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StopRule {
    /// max r < clock, as the paper has it (Algorithm 1).
    Clock,
    /// max |(1 - alpha)(y - x)| < distance, the stretch limits hold, and no body as a whole is further than `imbalance` from
    /// where the forces on it balance: the proximal term may still hold back a motion that is common to a body. Where no contact
    /// pushes, up to two more steps reach the target to the bit.
    Travel,
}

impl Default for Params {
    fn default() -> Self {
        Self::fast()
    }
}

impl Default for BackwardParams {
    fn default() -> Self {
        Self {
            sweeps: 8,
            polish_sweeps: 64,
            polish_distance: 1.0,
            edge_proximal: 0.1,
            contact_proximal: 0.1,
            proximal_growth: 32.0,
            coarse_correction: true,
            active_rows: true,
        }
    }
}

impl Default for StopParams {
    fn default() -> Self {
        Self {
            max_steps: None,
            max_seconds: None,
            rule: StopRule::Travel,
            distance: 0.01,
            imbalance: 0.2,
            drag: None,
            stretch_tolerance: 0.02,
            clock: 1e-4,
        }
    }
}

impl Params {
    /// The default: everything that measurements showed to pay.
    pub fn fast() -> Self {
        Self {
            constraints: ConstraintParams::default(),
            backward: BackwardParams::default(),
            stepper: StepperParams::default(),
            stop: StopParams::default(),
        }
    }

    /// The method as the paper describes it.
    pub fn paper() -> Self {
        Self {
            constraints: ConstraintParams::paper(),
            backward: BackwardParams {
                sweeps: 1,
                polish_sweeps: 1,
                edge_proximal: 0.0,
                contact_proximal: 0.0,
                proximal_growth: 1.0,
                coarse_correction: false,
                active_rows: false,
                ..BackwardParams::default()
            },
            stepper: StepperParams::paper(),
            stop: StopParams { rule: StopRule::Clock, ..StopParams::default() },
        }
    }

    /// Checks every field; the messages name the key, its value and what is allowed.
    ///
    /// # Errors
    /// One line for each field out of its range.
    pub fn validate(&self) -> Result<(), Vec<String>> {
        let mut problems = Vec::new();
        self.constraints.validate(&mut problems);
        self.stepper.validate(&mut problems);
        let mut check = |ok: bool, message: String| {
            if !ok {
                problems.push(message);
            }
        };
        let b = &self.backward;
        check(b.sweeps >= 1, format!("backward.sweeps = {} must be at least 1", b.sweeps));
        check(
            b.polish_sweeps >= b.sweeps,
            format!("backward.polish_sweeps = {} must be at least backward.sweeps", b.polish_sweeps),
        );
        let growth = b.proximal_growth;
        check(
            growth.is_finite() && growth >= 1.0,
            format!("backward.proximal_growth = {growth} must be finite and at least 1"),
        );
        let s = &self.stop;
        for (key, value) in [
            ("backward.polish_distance", b.polish_distance),
            ("backward.edge_proximal", b.edge_proximal),
            ("backward.contact_proximal", b.contact_proximal),
        ] {
            check(
                value.is_finite() && value >= 0.0,
                format!("{key} = {value} must be finite and at least 0"),
            );
        }
        for (key, value) in [
            ("stop.distance", s.distance),
            ("stop.drag", s.drag.unwrap_or(1.0)),
            ("stop.stretch_tolerance", s.stretch_tolerance),
            ("stop.clock", s.clock),
        ] {
            check(value.is_finite() && value > 0.0, format!("{key} = {value} must be finite and above 0"));
        }
        check(s.max_steps != Some(0), "stop.max_steps = 0 must be at least 1".to_owned());
        if let Some(seconds) = s.max_seconds {
            check(
                seconds.is_finite() && seconds > 0.0,
                format!("stop.max_seconds = {seconds} must be finite and above 0"),
            );
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }
}
