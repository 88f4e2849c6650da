//! The three stages of a two-way step, as traits: other methods plug in here.

use crate::{Problem, State, Statistics};
use bowknot_geometry::Vector;
use bowknot_stepper::StepReport;

/// Lists the pairs that the other stages work on.
pub trait Search: Send {
    /// Starts a call.
    fn begin(&mut self, problem: &Problem, state: &mut State);

    /// Makes `state.contacts` valid for `state.x`: every pair that could meet within the budgets is listed,
    /// with its contact geometry.
    fn update(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics);

    /// Lists instead every pair that could meet while each vertex moves from x along `displacements` on a common
    /// clock, straying from there by at most `deviations` [m].
    fn update_swept(
        &mut self,
        problem: &Problem,
        state: &mut State,
        displacements: &[Vector],
        deviations: &[f64],
        statistics: &mut Statistics,
    );

    /// Brings the contact geometry of the listed pairs up to date with `state.x`, without listing others.
    fn refresh(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics);

    /// Asks for a fresh search in the next update.
    fn request(&mut self);

    /// The budgets that the present list is good for.
    fn reach(&self) -> Reach<'_>;
}

/// How far vertices may go with the present list of pairs.
#[derive(Clone, Copy, Debug)]
pub enum Reach<'a> {
    /// One ball a vertex.
    Balls(&'a bowknot_stepper::Budgets),
    /// Unlisted pairs are at least this far apart [m]: the paper's D^(l).
    Distance(f64),
}

/// Brings the target y toward the intersection-free region.
pub trait BackwardStep: Send {
    /// Starts a call.
    fn begin(&mut self, problem: &Problem, state: &State);

    /// Writes `state.y` from `state.target`, linearised at `state.x`; keeps multipliers for the next step.
    fn project(&mut self, problem: &Problem, state: &mut State, statistics: &mut Statistics);

    /// Largest ratio of an edge's length to its limit at `state.x`; 1 or less: the limits hold. This and the next two are for
    /// [`crate::StopRule::Travel`]; a stage with a rule of its own, [`Self::settled`], needs none of them.
    fn stretch_to_limit(&self, _state: &State) -> f64 {
        1.0
    }

    /// Largest over bodies of the mean stationarity residual at `state.x` [m]: how far a body as a whole is from where
    /// the forces on it balance.
    fn imbalance(&mut self, _problem: &Problem, _state: &State) -> f64 {
        0.0
    }

    /// Largest over bodies of the mean of the vertices' stationarity residuals at `state.x` [m].
    fn unrest(&mut self, _problem: &Problem, _state: &State) -> f64 {
        0.0
    }

    /// Whether the loop may stop by the stage's own rule; None: by that of [`crate::StopParams`]. For descent methods, whose
    /// y is where one step should end rather than a target: having reached it says nothing about being done.
    fn settled(&self, _problem: &Problem, _state: &State) -> Option<bool> {
        None
    }

    /// Fills in what the stage knows at the end of a call: residuals and stretch.
    fn finish(&mut self, problem: &Problem, state: &State, statistics: &mut Statistics);
}

/// Moves x toward y without meeting anything on the way.
pub trait ForwardStep: Send {
    /// Starts a call.
    fn begin(&mut self, problem: &Problem, state: &State);

    /// Advances `state.x` toward `state.y`.
    fn advance(
        &mut self,
        problem: &Problem,
        state: &mut State,
        search: &mut dyn Search,
        statistics: &mut Statistics,
    ) -> StepReport;
}
