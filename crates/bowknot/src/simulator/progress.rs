//! When the iterations of a time step end.

/// Time step that tolerances are given for [s].
const REFERENCE_STEP: f64 = 0.01;

/// Share of the smallest residual so far that an iteration must get below to count as progress.
const MIN_REDUCTION: f64 = 0.7;

/// Iterations without progress, one after the other, after which the iterations end.
const MAX_STALLED_ITERATIONS: usize = 3;

/// Iterations without progress after which they count as oscillating about the solution.
const OSCILLATING: usize = 2;

/// Factor of the smallest residual within which iterations without progress may end: an iteration that has
/// just lost or found a contact can be far from the solution, with edges crushed.
const MAX_END_RATIO: f64 = 1.2;

/// Smallest residual so far, in tolerances, above which iterations go on without progress: cloth that folds
/// is crushed there.
const MAX_STALLED_RESIDUAL: f64 = 4.0;

/// The residuals of a time step, from iteration to iteration.
#[derive(Debug)]
pub(super) struct Progress {
    tolerance: f64,
    smallest: f64,
    stalled: usize,
}

impl Progress {
    /// Of a time step of `dt` [s], with the `tolerance` of the residual in one of 1/100 s [m]; 0: iterations
    /// never end by themselves.
    ///
    /// In shorter time steps the tolerance shrinks with their square, as what gravity does: else it would be
    /// an acceleration without bound. In longer ones it grows with them: a constant error of velocities.
    pub fn new(tolerance: f64, dt: f64) -> Self {
        let ratio = dt / REFERENCE_STEP;
        Self { tolerance: tolerance * ratio.min(ratio * ratio), smallest: f64::INFINITY, stalled: 0 }
    }

    /// The tolerance of the residual in force [m]; 0 if there is none.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Whether a time step that ends at `residual` [m] is solved: without a tolerance any is.
    pub fn solves(&self, residual: f64) -> bool {
        self.tolerance == 0.0 || residual <= self.tolerance
    }

    /// Whether the iterations oscillate about the solution.
    pub fn oscillates(&self) -> bool {
        self.stalled >= OSCILLATING
    }

    /// Whether an iteration that led to `residual` [m] is the last.
    pub fn ends(&mut self, residual: f64) -> bool {
        self.stalled = if residual > MIN_REDUCTION * self.smallest { self.stalled + 1 } else { 0 };
        self.smallest = self.smallest.min(residual);
        let far = self.smallest > MAX_STALLED_RESIDUAL * self.tolerance;
        let stalls =
            self.stalled >= MAX_STALLED_ITERATIONS && residual <= MAX_END_RATIO * self.smallest && !far;
        self.tolerance > 0.0 && (residual < self.tolerance || stalls)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn iterations_end_at_the_tolerance() {
        let mut progress = Progress::new(1e-3, 0.01);
        assert_eq!([0.1, 0.01, 0.9e-3].map(|r| progress.ends(r)), [false, false, true]);
    }

    #[test]
    fn iterations_without_progress_end_near_the_smallest_residual() {
        let mut progress = Progress::new(0.05, 0.01);
        let residuals = [1.0, 0.1, 0.09, 0.08, 0.5, 0.09];
        assert_eq!(residuals.map(|r| progress.ends(r)), [false, false, false, false, false, true]);
    }

    #[test]
    fn iterations_far_from_the_tolerance_go_on() {
        let mut progress = Progress::new(0.01, 0.01);
        let residuals = [1.0, 0.1, 0.09, 0.08, 0.5, 0.09, 0.04, 0.04, 0.04, 0.04];
        let ends = residuals.map(|r| progress.ends(r));
        assert_eq!(ends.iter().position(|end| *end), Some(9));
    }

    #[test]
    fn iterations_without_progress_oscillate_and_without_a_tolerance_never_end() {
        let mut progress = Progress::new(0.0, 0.01);
        let oscillates = [1.0, 0.9, 0.8, 0.7, 0.1].map(|r| (progress.ends(r), progress.oscillates()));
        assert_eq!(oscillates, [false, false, true, true, false].map(|oscillates| (false, oscillates)));
    }

    #[test]
    fn a_residual_up_to_the_tolerance_solves_and_without_a_tolerance_any_does() {
        let progress = Progress::new(1e-3, 0.02);
        assert_eq!(progress.tolerance(), 2e-3);
        assert_eq!([0.0, 2e-3, 2.1e-3, f64::NAN].map(|r| progress.solves(r)), [true, true, false, false]);
        assert!(Progress::new(0.0, 0.01).solves(1.0));
    }

    #[test]
    fn the_tolerance_stands_for_an_acceleration_in_short_steps_and_a_velocity_in_long_ones() {
        assert!((Progress::new(1.0, 0.001).tolerance - 0.01).abs() < 1e-15);
        assert!((Progress::new(1.0, 0.05).tolerance - 5.0).abs() < 1e-12);
    }
}
