//! What a call reports.

use serde::{Deserialize, Serialize};

/// What one call of [`crate::Resolver::resolve`] did and how it ended.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// Two-way steps taken.
    pub steps: usize,
    /// Proximity searches made.
    pub searches: usize,
    /// Pairs listed after the last search.
    pub pairs: usize,
    /// Contact rows of the last backward step.
    pub contact_rows: usize,
    /// Friction rows of the last backward step: contacts between bodies with friction.
    pub friction_rows: usize,
    /// Contacts that pressed and stuck in the last backward step.
    pub sticking_contacts: usize,
    /// Contacts that pressed and slid in the last backward step.
    pub sliding_contacts: usize,
    /// Largest slip of a sticking contact since the start of the time step [m]: 0 for a solved problem.
    pub creep_m: f64,
    /// Edge rows of the last backward step.
    pub edge_rows: usize,
    /// Rows swept in the last backward step, contacts and edges that push.
    pub active_rows: usize,
    /// Pairs frozen for want of a certificate, over all steps.
    pub frozen_pairs: usize,
    /// Pairs whose desired distance was lowered because they are neighbours in a fine mesh.
    pub lowered_pairs: usize,
    /// Colours of the edge rows.
    pub edge_colours: usize,
    /// Colours of the contact rows, last backward step.
    pub contact_colours: usize,
    /// Whether the stopping rule was met.
    pub converged: bool,
    /// Largest clock r (paper, Eq. 20).
    pub remaining_r: f64,
    /// Largest distance not travelled, max |y - x| [m].
    pub remaining_m: f64,
    /// Stationarity residual max |y0 + m^-1 J^T lambda - x| [m].
    pub stationarity_m: f64,
    /// Largest over bodies of |mean of m^ (y0 + m^-1 J^T lambda - x)| [m]: how far a body as a whole is from where the
    /// forces that act on it would balance.
    pub imbalance_m: f64,
    /// Complementarity max |min(lambda, s)| over the rows [m].
    pub complementarity_m: f64,
    /// Root mean square over free vertices of |x - y0| [m].
    pub distance_to_target_m: f64,
    /// Smallest distance over the listed pairs at the end [m]; none if no pair is listed.
    pub min_gap_m: Option<f64>,
    /// Largest ratio of an edge's length to its length at the start of the call.
    pub max_step_stretch: f64,
    /// Largest ratio of an edge's length to its rest length.
    pub max_stretch: f64,
    /// Largest distance by which an obstacle or pin is behind its keyframe [m].
    pub prescribed_behind_m: f64,
    /// Obstacles and groups of pinned vertices that wait because going on would cut through something, or for want of
    /// steps: those behind by more than the stopping rule's distance.
    pub behind: Vec<Behind>,
    /// Largest kinetic energy that separating contacts to their desired distance can have injected [J]: the sum over
    /// vertices of 1/2 m (s/dt)^2, s the largest way that a pressing contact of the vertex asks its gap to grow
    /// in this call, at most the separation speed times dt. 0 for a call without a time step.
    pub injected_j: f64,
    /// Body with the vertex that has travelled least of its way, if the call did not converge.
    pub slowest_body: Option<u32>,
    /// Wall seconds by stage.
    pub seconds: StageSeconds,
    /// Work that was skipped.
    pub skipped: Skipped,
}

/// Something prescribed that waits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Behind {
    /// Who waits.
    pub who: Follower,
    /// How far it is behind its keyframe, at its farthest vertex [m].
    pub distance_m: f64,
}

/// Who follows keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Follower {
    /// An obstacle: its body.
    Obstacle(u32),
    /// A group of pinned vertices, as named in [`crate::Call::groups`].
    Group(u32),
    /// The pinned vertices of a body that are in no group.
    Pins(u32),
}

/// Wall seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageSeconds {
    /// The whole call.
    pub total: f64,
    /// Proximity search.
    pub search: f64,
    /// Contact geometry of the listed pairs.
    pub evaluate: f64,
    /// Backward step.
    pub backward: f64,
    /// Forward step.
    pub forward: f64,
}

impl StageSeconds {
    /// Of the search stage, which the forward step may call on its way.
    pub(crate) fn of_search(&self) -> f64 {
        self.search + self.evaluate
    }
}

/// Work that was skipped because nothing needed it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Skipped {
    /// Steps that reused the pairs of an earlier search.
    pub searches: usize,
    /// Pair evaluations reused because no vertex of the pair had moved.
    pub evaluations: usize,
    /// Contact rows left out of the sweeps.
    pub rows: usize,
}
