//! The three stages of a two-way step, as traits: other methods implement them.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use crate::statistics::Statistics;
use crate::stop::Residuals;
use crate::waits::Wait;
use bowknot_stepper::{StepReport, TrustRegions};

/// Finds the candidate pairs that the other stages work on.
pub trait Search: Send {
    /// Starts a call. `complete`: whether `state.contacts` must have every pair that could meet within the
    /// trust regions. Otherwise it may lack pairs beyond contact range, which the forward stage asks for.
    fn begin(&mut self, scene: &CollisionScene, state: &mut ResolveState, complete: bool);

    /// Makes `state.contacts` valid for `state.x`: it then has every pair within contact range, or every pair
    /// that could meet, with its contact geometry.
    fn update(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics);

    /// Makes `state.contacts` valid for `state.x` at the end of a call. Adds the number of candidate pairs to
    /// the statistics.
    fn finish(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics);

    /// Asks for a search in the next update.
    fn request(&mut self);

    /// How far vertices may go with the present candidates.
    fn coverage(&self) -> Coverage<'_>;
}

/// How far vertices may go before the list of candidate pairs is incomplete.
#[derive(Clone, Copy, Debug)]
pub enum Coverage<'a> {
    /// Each vertex as far as its trust region.
    TrustRegions(&'a TrustRegions),
    /// Pairs that are no candidates are at least this far apart [m]: the paper's D^(l).
    Distance(f64),
}

/// Moves the target y toward the intersection-free region.
pub trait BackwardStep: Send {
    /// Starts a call.
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState);

    /// Computes `state.y` from `state.target`, linearized at `state.x`. Multipliers are kept for the next
    /// step.
    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics);

    /// Residuals at `state.x`, for [`crate::StopRule::Travel`]. A stage with a rule of its own,
    /// [`Self::converged`], needs none.
    fn residuals(&mut self, _scene: &CollisionScene, _state: &ResolveState) -> Residuals {
        Residuals::default()
    }

    /// Whether the call has converged by the stage's own rule. None: [`crate::StopRule`] decides. Descent
    /// methods need a rule of their own: their y is the end of one step rather than a target, so that
    /// reaching it does not mean convergence.
    fn converged(&self, _scene: &CollisionScene, _state: &ResolveState) -> Option<bool> {
        None
    }

    /// Adds the residuals and stretches at the end of a call to the statistics.
    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics);
}

/// Moves x toward y on paths without intersections, with the candidates of a search.
pub trait ForwardStep<S: Search>: Send {
    /// Whether the stage asks the search for pairs beyond contact range. If not, `state.contacts` has all
    /// pairs that could meet.
    fn visits_ahead(&self) -> bool {
        false
    }

    /// Starts a call.
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState);

    /// Moves `state.x` toward `state.y`.
    fn advance(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut S,
        statistics: &mut Statistics,
    ) -> StepReport;

    /// What holds back the vertices that have farthest to go after [`Self::advance`], farthest first; see
    /// [`Wait`]. Called before the next update of `state.contacts`.
    fn waits(&self, _scene: &CollisionScene, _state: &ResolveState) -> Vec<Wait> {
        Vec::new()
    }
}
