//! Calls in which no progress is possible.

/// Detects a call that stalls: prescribed vertices are blocked, and all free vertices have arrived or none
/// moves any more. To wait for those would use up all steps of this call, and of every following one.
#[derive(Debug)]
pub struct StallDetector {
    /// Mean edge length [m].
    edge: f64,
    /// Distance at which a vertex has arrived [m].
    tolerance: f64,
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
    /// Smallest move of a free vertex in a step that counts as one, in mean edge lengths.
    const MIN_MOVE: f64 = 1e-3;

    /// Starts a call in a scene with edges of the mean length `edge` [m], whose vertices have arrived at the
    /// distance `tolerance` [m].
    pub fn new(edge: f64, tolerance: f64) -> Self {
        Self { edge, tolerance, smallest_lag: None, steps_without_progress: 0 }
    }

    /// The number of steps that the call can make before it may stall after the last of them.
    pub fn steps_left(&self) -> usize {
        Self::MAX_STEPS_WITHOUT_PROGRESS - self.steps_without_progress
    }

    /// Whether the call stalls, as of the state after a step. `lag` is the largest distance of a prescribed
    /// vertex to its keyframe [m], `remaining` that of a free vertex to where the step wanted to go [m]. A
    /// stage may move prescribed vertices to their keyframes by way of other positions, so where the step
    /// wanted to go does not tell how far those have to go. `moved` is the longest move of a free vertex in
    /// the step [m].
    pub fn update(&mut self, lag: f64, remaining: impl FnOnce() -> f64, moved: impl FnOnce() -> f64) -> bool {
        if self.smallest_lag.is_none_or(|smallest| lag < smallest - Self::MIN_PROGRESS * self.edge) {
            self.smallest_lag = Some(lag);
            self.steps_without_progress = 0;
            return false;
        }
        let free_vertices_move = || remaining() > self.tolerance && moved() > Self::MIN_MOVE * self.edge;
        if lag < self.tolerance || free_vertices_move() {
            self.steps_without_progress = 0;
            return false;
        }
        self.steps_without_progress += 1;
        self.steps_without_progress >= Self::MAX_STEPS_WITHOUT_PROGRESS
    }
}
