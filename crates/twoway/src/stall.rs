//! Calls in which no progress is possible.

use crate::scene::CollisionScene;
use crate::state::ResolveState;

/// Detects a call that stalls: all free vertices have arrived, and prescribed vertices are blocked. To wait
/// for those would use up all steps of this call, and of every following one.
#[derive(Debug, Default)]
pub(crate) struct StallDetector {
    /// Smallest lag of the prescribed vertices so far [m].
    smallest_lag: Option<f64>,
    /// Steps since it last shrank noticeably.
    steps_without_progress: usize,
}

impl StallDetector {
    /// Number of steps without progress after which the call ends.
    const MAX_STEPS_WITHOUT_PROGRESS: usize = 16;
    /// Smallest decrease of the lag that counts as progress, in mean edge lengths.
    const MIN_PROGRESS: f64 = 1e-3;

    /// Whether the call stalls, as of the state after a step.
    pub(crate) fn update(&mut self, scene: &CollisionScene, state: &ResolveState) -> bool {
        let farthest = |prescribed: bool| {
            // A stage may move prescribed vertices to their keyframes by way of other positions, so y does
            // not tell how far they have to go.
            let ends = if prescribed { &state.target } else { &state.y };
            let vertices = (0..state.x.len()).filter(|&v| state.call.is_prescribed(v) == prescribed);
            vertices.map(|v| (ends[v] - state.x[v]).norm()).fold(0.0, f64::max)
        };
        let edge = scene.lengths().edge;
        let lag = farthest(true);
        if self.smallest_lag.is_none_or(|smallest| lag < smallest - Self::MIN_PROGRESS * edge) {
            self.smallest_lag = Some(lag);
            self.steps_without_progress = 0;
            return false;
        }
        let tolerance = scene.params().solver.stop.distance * edge;
        if lag < tolerance || farthest(false) > tolerance {
            self.steps_without_progress = 0;
            return false;
        }
        self.steps_without_progress += 1;
        self.steps_without_progress >= Self::MAX_STEPS_WITHOUT_PROGRESS
    }
}
