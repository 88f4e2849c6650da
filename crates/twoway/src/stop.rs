//! When a call ends: limits, and the stopping rule. The stages return residuals, the rule decides.

use bowknot_errors::{Checks, Parameters};
use bowknot_stepper::StepReport;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Largest number of steps beyond [`StopRule::Travel`] while no contact presses: the target is then reached
/// to the bit, and momentum with it.
const MAX_FINISHING_STEPS: usize = 2;

/// Largest remaining distance of a vertex that no pair holds back, in mean edge lengths, however large
/// [`StopParams::distance`] is: what moves freely would be slowed down otherwise.
const UNHINDERED: f64 = 0.01;

/// Default of the field `residual` of [`StopRule::Travel`].
const DEFAULT_RESIDUAL: f64 = 1e-4;

/// When a call ends.
///
/// As a table, for example in a file, the fields of the rule are keys beside `rule`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(from = "StopTable", into = "StopTable"))]
pub struct StopParams {
    /// Largest number of two-way steps, the paper's L. Default: by the time step, 512 up to dt = 1/100 s,
    /// 2048 from dt = 1/20 s, linear in dt between. In a simulation, a call that another Newton iteration
    /// follows ends after 24.
    pub max_steps: Option<usize>,
    /// Largest wall time of one call [s]. Default: no limit.
    pub max_seconds: Option<f64>,
    /// The stopping rule. Default travel.
    pub rule: StopRule,
    /// Largest remaining distance of a vertex that has arrived, in mean edge lengths. It is part of the rule
    /// `travel`, and obstacles and pins that are farther from their keyframes count as lagging. Default 0.01.
    pub distance: f64,
    /// By how much edges may exceed their stretch limits, relative. It is part of the rule `travel`, and the
    /// backward step polishes the target until half of it. Default 0.02.
    pub stretch_tolerance: f64,
}

/// The quantity that ends a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopRule {
    /// The rule of the paper (Algorithm 1): max r < `remaining_fraction`.
    Clock {
        /// Rule `clock`: largest remaining fraction r of any vertex, the paper's epsilon. Default 1e-4.
        remaining_fraction: f64,
    },
    /// All vertices have arrived, max |(1 - alpha)(y - x)| < `distance`; those that no pair holds back within
    /// 0.01 mean edge lengths, prescribed ones among them exactly; the stretch limits hold; and both
    /// residuals are small. Small residuals are needed because the proximal term may still hold back a motion
    /// that is common to a body. Where no contact presses, up to two more steps reach the target to the bit.
    Travel {
        /// Rule `travel`: largest net residual, in mean edge lengths: how far a body as a whole is from where
        /// the forces on it balance. 0 is never reached. Default 0.2.
        net_residual: f64,
        /// Rule `travel`: residual tolerance, the largest mean residual of a body's vertices, in mean edge
        /// lengths; it applies only as long as each step halves the mean residual. It bounds how much the
        /// proximal term slows down bodies that slide. Smaller: one or two more steps per call. The default
        /// is 1e-4.
        residual: Option<f64>,
    },
}

/// How far a state is from the solution, as the backward step measures it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// Largest net residual of a body [m]: the length of the mean stationarity residual of its vertices,
    /// weighted by mass. It tells how far the body as a whole is from where the forces on it balance.
    pub net_residual: f64,
    /// Largest mean residual of a body [m]: the mean length of the stationarity residuals of its vertices,
    /// weighted by mass.
    pub mean_residual: f64,
    /// Largest ratio of an edge's length to its limit [1]. At 1 or less, the limits hold.
    pub stretch_to_limit: f64,
}

impl Default for Residuals {
    fn default() -> Self {
        Self { net_residual: 0.0, mean_residual: 0.0, stretch_to_limit: 1.0 }
    }
}

impl StopRule {
    /// The rule of the paper, with its default.
    pub fn clock() -> Self {
        Self::Clock { remaining_fraction: 1e-4 }
    }

    /// The default rule.
    pub fn travel() -> Self {
        Self::Travel { net_residual: 0.2, residual: None }
    }
}

impl StopParams {
    /// Those of [`crate::Params::quick`]: a call ends as soon as all vertices are near their targets. The
    /// residuals are so loose that they rarely take another step.
    pub fn quick() -> Self {
        let rule = StopRule::Travel { net_residual: 1.0, residual: Some(1.0) };
        Self { rule, distance: 0.1, ..Self::default() }
    }
}

impl Default for StopParams {
    fn default() -> Self {
        Self {
            max_steps: None,
            max_seconds: None,
            rule: StopRule::travel(),
            distance: 0.01,
            stretch_tolerance: 0.02,
        }
    }
}

impl Parameters for StopParams {
    fn check(&self, checks: &mut Checks) {
        if let Some(steps) = self.max_steps {
            checks.count_at_least("max_steps", steps, 1);
        }
        if let Some(seconds) = self.max_seconds {
            checks.positive("max_seconds", seconds);
        }
        match self.rule {
            StopRule::Clock { remaining_fraction } => {
                checks.positive("remaining_fraction", remaining_fraction);
            }
            StopRule::Travel { net_residual, residual } => {
                checks.non_negative("net_residual", net_residual);
                if let Some(residual) = residual {
                    checks.positive("residual", residual);
                }
            }
        }
        checks.positive("distance", self.distance);
        checks.positive("stretch_tolerance", self.stretch_tolerance);
    }
}

/// What [`StopRule::Travel`] compares with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TravelLimits {
    /// The remaining distances of all vertices are below this [m].
    pub remaining: f64,
    /// Those of vertices that no pair holds back are below this [m].
    pub unhindered: f64,
    /// The net residuals are below this [m].
    pub net_residual: f64,
    /// The largest mean residual is below this [m], or the last step has not halved it.
    pub mean_residual: f64,
    /// Largest ratio of an edge's length to its limit [1].
    pub stretch_to_limit: f64,
    /// Most steps beyond the rule, made while vertices have some way to go and no contact presses.
    pub finishing_steps: usize,
}

impl TravelLimits {
    fn new(params: &StopParams, edge: f64, net_residual: f64, residual: Option<f64>) -> Self {
        Self {
            remaining: params.distance * edge,
            unhindered: UNHINDERED * edge,
            net_residual: net_residual * edge,
            mean_residual: residual.unwrap_or(DEFAULT_RESIDUAL) * edge,
            stretch_to_limit: 1.0 + params.stretch_tolerance,
            finishing_steps: MAX_FINISHING_STEPS,
        }
    }
}

/// Decides during a call whether it ends.
#[derive(Debug)]
pub struct StopTest {
    params: StopParams,
    /// Mean edge length [m].
    edge: f64,
    /// Largest number of two-way steps.
    max_steps: usize,
    /// Mean residual of the last step that met all other conditions of [`StopRule::Travel`] [m].
    mean_residual: f64,
    finishing_steps: usize,
}

impl StopTest {
    /// Starts a call that stands for `time_step` [s]. `max_steps` is the caller's own limit on the number of
    /// steps.
    pub fn new(params: &StopParams, edge: f64, time_step: Option<f64>, max_steps: Option<usize>) -> Self {
        let limit = params.max_steps.unwrap_or_else(|| default_max_steps(time_step));
        Self {
            params: params.clone(),
            edge,
            max_steps: max_steps.map_or(limit, |own| own.min(limit)),
            mean_residual: f64::INFINITY,
            finishing_steps: 0,
        }
    }

    /// Largest number of two-way steps.
    pub fn max_steps(&self) -> usize {
        self.max_steps
    }

    /// Whether the call may take another step after `steps` steps.
    pub fn allows_step(&self, steps: usize) -> bool {
        steps < self.max_steps
    }

    /// Whether the call has used up its wall time.
    pub fn is_out_of_time(&self, elapsed_seconds: f64) -> bool {
        self.params.max_seconds.is_some_and(|limit| elapsed_seconds > limit)
    }

    /// Whether a step met the rule. `residuals` are those of the state after it; they are asked for only if
    /// needed.
    pub fn is_met(&mut self, report: &StepReport, residuals: impl FnOnce() -> Residuals) -> bool {
        let (params, edge) = (&self.params, self.edge);
        match params.rule {
            StopRule::Clock { remaining_fraction } => report.remaining_fraction < remaining_fraction,
            StopRule::Travel { net_residual, residual } => {
                let limits = TravelLimits::new(params, edge, net_residual, residual);
                let has_arrived = report.remaining < limits.remaining
                    && report.unhindered < limits.unhindered
                    && report.unhindered_lag == 0.0;
                if !has_arrived {
                    return false;
                }
                let now = residuals();
                let balances = now.net_residual < limits.net_residual;
                let limits_hold = now.stretch_to_limit <= limits.stretch_to_limit;
                if !(balances && limits_hold) {
                    return false;
                }
                let last = std::mem::replace(&mut self.mean_residual, now.mean_residual);
                now.mean_residual < limits.mean_residual || now.mean_residual > 0.5 * last
            }
        }
    }

    /// What the rule [`StopRule::Travel`] compares with, for a backend that decides by itself; none with
    /// another rule.
    pub fn travel_limits(&self) -> Option<TravelLimits> {
        match self.params.rule {
            StopRule::Travel { net_residual, residual } => {
                Some(TravelLimits::new(&self.params, self.edge, net_residual, residual))
            }
            StopRule::Clock { .. } => None,
        }
    }

    /// Whether a call that has converged takes another step, to reach the target to the bit, after `steps`
    /// steps.
    pub fn takes_finishing_step(
        &mut self,
        report: &StepReport,
        steps: usize,
        no_contact_presses: impl FnOnce() -> bool,
    ) -> bool {
        let takes = matches!(self.params.rule, StopRule::Travel { .. })
            && report.remaining > 0.0
            && self.finishing_steps < MAX_FINISHING_STEPS
            && self.allows_step(steps)
            && no_contact_presses();
        self.finishing_steps += usize::from(takes);
        takes
    }
}

/// The paper's step limits: 512 up to dt = 1/100, 2048 from 1/20, linear between.
fn default_max_steps(time_step: Option<f64>) -> usize {
    let share = time_step.map_or(0.0, |dt| ((dt - 0.01) / 0.04).clamp(0.0, 1.0));
    512 + (share * 1536.0).round() as usize
}

/// [`StopParams`] as a table.
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
struct StopTable {
    max_steps: Option<usize>,
    max_seconds: Option<f64>,
    rule: RuleName,
    distance: f64,
    stretch_tolerance: f64,
    remaining_fraction: Option<f64>,
    net_residual: Option<f64>,
    residual: Option<f64>,
}

#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
enum RuleName {
    Clock,
    Travel,
}

impl Default for StopTable {
    fn default() -> Self {
        StopParams::default().into()
    }
}

impl From<StopParams> for StopTable {
    fn from(params: StopParams) -> Self {
        let StopParams { max_steps, max_seconds, rule, distance, stretch_tolerance } = params;
        let (rule, remaining_fraction, net_residual, residual) = match rule {
            StopRule::Clock { remaining_fraction } => (RuleName::Clock, Some(remaining_fraction), None, None),
            StopRule::Travel { net_residual, residual } => {
                (RuleName::Travel, None, Some(net_residual), residual)
            }
        };
        Self {
            max_steps,
            max_seconds,
            rule,
            distance,
            stretch_tolerance,
            remaining_fraction,
            net_residual,
            residual,
        }
    }
}

impl From<StopTable> for StopParams {
    fn from(table: StopTable) -> Self {
        let mut rule = match table.rule {
            RuleName::Clock => StopRule::clock(),
            RuleName::Travel => StopRule::travel(),
        };
        match &mut rule {
            StopRule::Clock { remaining_fraction } => {
                *remaining_fraction = table.remaining_fraction.unwrap_or(*remaining_fraction);
            }
            StopRule::Travel { net_residual, residual } => {
                *net_residual = table.net_residual.unwrap_or(*net_residual);
                *residual = table.residual;
            }
        }
        Self {
            max_steps: table.max_steps,
            max_seconds: table.max_seconds,
            rule,
            distance: table.distance,
            stretch_tolerance: table.stretch_tolerance,
        }
    }
}

#[cfg(test)]
mod tests;
