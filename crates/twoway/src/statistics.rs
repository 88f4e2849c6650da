//! Statistics of a call.

use crate::lag::Lag;
use crate::waits::Wait;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// What a call of [`crate::Resolver::resolve`] did and how it ended.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Statistics {
    /// Two-way steps taken.
    pub steps: usize,
    /// Proximity searches made.
    pub searches: usize,
    /// Candidate pairs after the last search.
    pub pairs: usize,
    /// Contact rows of the last backward step.
    pub contact_rows: usize,
    /// Friction rows of the last backward step: contacts between bodies with friction.
    pub friction_rows: usize,
    /// Contacts that pressed and stuck in the last backward step.
    pub sticking_contacts: usize,
    /// Contacts that pressed and slid in the last backward step.
    pub sliding_contacts: usize,
    /// Largest slip of a sticking contact since the start of the time step [m]: 0 for an exact solution.
    pub sticking_slip_m: f64,
    /// Edge rows of the last backward step.
    pub edge_rows: usize,
    /// Contact and edge rows with a multiplier after the last backward step.
    pub active_rows: usize,
    /// Pairs frozen because no direction certifies their gap, over all steps.
    pub frozen_pairs: usize,
    /// Pairs whose contact distance was lowered because they are neighbors in a fine mesh.
    pub lowered_pairs: usize,
    /// Colors of the edge rows.
    pub edge_colors: usize,
    /// Colors of the contact rows in the last backward step.
    pub contact_colors: usize,
    /// Whether the stopping rule was met.
    pub converged: bool,
    /// Largest remaining fraction r (paper, Eq. 20).
    pub remaining_r: f64,
    /// Largest remaining distance, max |y - x| [m].
    pub remaining_m: f64,
    /// Stationarity residual max |y0 + m^-1 J^T lambda - x| [m].
    pub stationarity_m: f64,
    /// Largest net residual of a body, |mean of m^ (y0 + m^-1 J^T lambda - x)| [m]: how far a body as a whole
    /// is from where the forces on it balance.
    pub net_residual_m: f64,
    /// Complementarity max |min(lambda, s)| over the rows [m].
    pub complementarity_m: f64,
    /// Root mean square over free vertices of |x - y0| [m].
    pub distance_to_target_m: f64,
    /// Smallest distance of a candidate pair at the end [m]; none if there are no candidates.
    pub min_gap_m: Option<f64>,
    /// Largest ratio of a deformable body's edge to its length at the start of the call, with or without a
    /// stretch limit.
    pub max_step_stretch: f64,
    /// Largest ratio of a deformable body's edge to its rest length.
    pub max_stretch: f64,
    /// Largest distance of an obstacle's or pin's vertex to its keyframe [m].
    pub prescribed_lag_m: f64,
    /// Obstacles and pinned vertices that lag behind their keyframes by more than `solver.stop.distance`,
    /// because going on would cut through something or because the steps were used up.
    pub lags: Vec<Lag>,
    /// Bound of the kinetic energy that separating contacts to their contact distance has injected [J]: the
    /// sum over vertices of 1/2 m (s/dt)^2, where s is the largest growth of a gap that a pressing contact of
    /// the vertex asks for in this call, at most the separation speed times dt. 0 for a call without a time
    /// step.
    pub injected_j: f64,
    /// Body of the vertex with the largest remaining distance, if the call did not converge.
    pub slowest_body: Option<u32>,
    /// What held back the vertices that had farthest to go in the last step, if the call took 32 steps or
    /// more, or did not converge, unless [`crate::ResolveInput::max_steps`] cut it short.
    #[cfg_attr(feature = "serde", serde(default))]
    pub waits: Vec<Wait>,
    /// Wall seconds by stage.
    pub seconds: StageSeconds,
    /// Work that was skipped.
    pub skipped: Skipped,
}

/// Wall seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct StageSeconds {
    /// The whole call.
    pub total: f64,
    /// Proximity search.
    pub search: f64,
    /// Contact geometry of the candidate pairs.
    pub evaluate: f64,
    /// Backward step.
    pub backward: f64,
    /// Forward step.
    pub forward: f64,
}

impl StageSeconds {
    /// Seconds of the search stage, which the forward step may call as well.
    pub(crate) fn of_search(&self) -> f64 {
        self.search + self.evaluate
    }
}

/// Work that was skipped because nothing needed it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Skipped {
    /// Steps that reused the pairs of an earlier search.
    pub searches: usize,
    /// Pair evaluations reused because no vertex of the pair had moved.
    pub evaluations: usize,
    /// Contact rows left out of the sweeps.
    pub rows: usize,
}
