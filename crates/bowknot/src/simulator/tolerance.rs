//! When the iterations of a time step end.

/// Time step that tolerances are given for [s].
const REFERENCE_STEP: f64 = 0.01;

/// Tolerance of the residual of a time step [m]; 0: iterations never end by themselves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance(f64);

impl Tolerance {
    /// In a time step of `dt` [s], with the `tolerance` in one of 1/100 s [m].
    ///
    /// In shorter time steps it shrinks with their square, as what gravity does: else it would be an
    /// acceleration without bound. In longer ones it grows with them: a constant error of velocities.
    pub fn new(tolerance: f64, dt: f64) -> Self {
        let ratio = dt / REFERENCE_STEP;
        Self(tolerance * ratio.min(ratio * ratio))
    }

    /// Its value [m]; 0 if there is none.
    pub fn meters(self) -> f64 {
        self.0
    }

    /// Whether iterations end at `residual` [m].
    pub fn ends(self, residual: f64) -> bool {
        self.0 > 0.0 && residual <= self.0
    }

    /// Whether a time step that ends at `residual` [m] is solved: without a tolerance any is.
    pub fn solves(self, residual: f64) -> bool {
        self.0 == 0.0 || residual <= self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_up_to_the_tolerance_ends_and_solves() {
        let tolerance = Tolerance::new(1e-3, 0.02);
        assert_eq!(tolerance.meters(), 2e-3);
        for (residual, solved) in [(0.0, true), (2e-3, true), (2.1e-3, false), (f64::NAN, false)] {
            assert_eq!(
                (tolerance.ends(residual), tolerance.solves(residual)),
                (solved, solved),
                "{residual}"
            );
        }
    }

    #[test]
    fn without_a_tolerance_nothing_ends_and_all_is_solved() {
        let none = Tolerance::new(0.0, 0.01);
        assert!(!none.ends(0.0) && none.solves(1.0));
    }

    #[test]
    fn the_tolerance_stands_for_an_acceleration_in_short_steps_and_a_velocity_in_long_ones() {
        assert!((Tolerance::new(1.0, 0.001).meters() - 0.01).abs() < 1e-15);
        assert!((Tolerance::new(1.0, 0.05).meters() - 5.0).abs() < 1e-12);
    }
}
