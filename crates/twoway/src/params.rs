//! Parameters of the two-way method: every switch is a field, and there are three presets.

use crate::stop::{StopParams, StopRule};
use bowknot_constraints::ContactParams;
use bowknot_errors::{Checks, Parameters};
use bowknot_stepper::ForwardParams;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Parameters of [`crate::Resolver`]. `Params::default()` is [`Params::fast`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Params {
    /// Contacts and edge-length limits.
    pub contact: ContactParams,
    /// The two-way loop.
    pub solver: SolverParams,
}

/// Parameters of the two-way loop.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct SolverParams {
    /// The backward step.
    pub backward: BackwardParams,
    /// The forward step and the trust regions.
    pub forward: ForwardParams,
    /// When a call ends.
    pub stop: StopParams,
}

/// Parameters of the backward step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct BackwardParams {
    /// Gauss-Seidel sweeps per backward step, on the CPU and on a GPU. More: a more accurate target, slower
    /// steps. Default 8 (paper: 1).
    pub sweeps: usize,
    /// Largest number of sweeps once the remaining distance is below `polish_distance`, while the target
    /// stretches edges beyond their limits by more than half of `solver.stop.stretch_tolerance`. Default 64.
    pub polish_sweeps: usize,
    /// Remaining distance below which `polish_sweeps` applies, in mean edge lengths. Default 1.
    pub polish_distance: f64,
    /// Strength of the proximal term on edges: mu_i += edge_proximal * sum lambda_e / |e|. Smaller: closer to
    /// the true projection, until edges no longer come to rest; 0 switches it off (the linear form needs 2).
    /// Default 0.1.
    pub edge_proximal: f64,
    /// Strength of the proximal term on contacts: mu_i += contact_proximal * sum lambda_p |g| / r. Here r is
    /// the radius of curvature of the contact: the edge length, or the distance where vertices or parallel
    /// edges meet. Default 0.1.
    pub contact_proximal: f64,
    /// Largest factor on the proximal term of a vertex. The factor doubles each time that the wanted
    /// displacement of the vertex reverses from one step to the next, and falls slowly otherwise. 1: no
    /// factor. Default 32.
    pub proximal_growth: f64,
    /// Whether a common factor of all multipliers is optimized before each sweep. Default true.
    pub coarse_correction: bool,
    /// Whether the sweeps leave out rows that neither press nor are predicted to close, and all but one of the
    /// pairs with the same closest points. Default true.
    pub active_rows: bool,
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

/// Factor on the sweeps of calls in which rows alone hold some vertices, beside a target that knows its other
/// contacts. More: piles stand steeper, as they should. Fewer: less time.
const UNKNOWN_SWEEPS: usize = 4;

impl BackwardParams {
    /// Sweeps of a backward step that does not polish, on the CPU and on a device. `has_unknown`: rows alone hold
    /// some vertices.
    pub fn sweeps_of(&self, has_unknown: bool) -> usize {
        if has_unknown { UNKNOWN_SWEEPS * self.sweeps } else { self.sweeps }
    }

    /// The values of the paper.
    pub fn paper() -> Self {
        Self {
            sweeps: 1,
            polish_sweeps: 1,
            edge_proximal: 0.0,
            contact_proximal: 0.0,
            proximal_growth: 1.0,
            coarse_correction: false,
            active_rows: false,
            ..Self::default()
        }
    }
}

impl Params {
    /// The default: every switch that makes the method faster or more accurate in the benchmarks.
    pub fn fast() -> Self {
        Self { contact: ContactParams::default(), solver: SolverParams::default() }
    }

    /// [`Params::fast`] that stops early, with the same guarantee: vertices that contacts hold back end
    /// within a tenth of the mean edge length of their targets, and what then still presses is left to the
    /// next call.
    pub fn quick() -> Self {
        let mut params = Self::fast();
        params.solver.stop = StopParams::quick();
        params
    }

    /// The method as the paper describes it.
    pub fn paper() -> Self {
        let stop = StopParams { rule: StopRule::clock(), ..StopParams::default() };
        Self {
            contact: ContactParams::paper(),
            solver: SolverParams { backward: BackwardParams::paper(), forward: ForwardParams::paper(), stop },
        }
    }
}

impl Parameters for Params {
    fn check(&self, checks: &mut Checks) {
        checks.within("contact", &self.contact);
        checks.within("solver", &self.solver);
    }
}

impl Parameters for SolverParams {
    fn check(&self, checks: &mut Checks) {
        checks.within("backward", &self.backward);
        checks.within("forward", &self.forward);
        checks.within("stop", &self.stop);
    }
}

impl Parameters for BackwardParams {
    fn check(&self, checks: &mut Checks) {
        checks.count_at_least("sweeps", self.sweeps, 1);
        checks.require(
            self.polish_sweeps >= self.sweeps,
            "polish_sweeps",
            self.polish_sweeps,
            format_args!("must be at least sweeps, {}", self.sweeps),
        );
        checks.non_negative("polish_distance", self.polish_distance);
        checks.non_negative("edge_proximal", self.edge_proximal);
        checks.non_negative("contact_proximal", self.contact_proximal);
        checks.at_least("proximal_growth", self.proximal_growth, 1.0);
    }
}

#[cfg(test)]
mod tests;
