//! When the iterations of a time step end.

use bowknot_dynamics::Integrator;

/// Time step that tolerances are given for [s].
const REFERENCE_STEP: f64 = 0.01;

/// Tolerance of the residual of a time step [m]; 0: iterations never end by themselves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance(f64);

impl Tolerance {
    /// In a time step of `dt` [s] by an `integrator`, with the `tolerance` in one of 1/100 s by implicit Euler [m].
    ///
    /// In shorter time steps it shrinks with their square, as what gravity does: else it would be an
    /// acceleration without bound. In longer ones it grows with them: a constant error of velocities. A method of
    /// second order has a smaller one by the length of its stages, which shrinks with the cube of the time step, as
    /// its own error does.
    pub fn new(tolerance: f64, dt: f64, integrator: Integrator) -> Self {
        let ratio = dt / REFERENCE_STEP;
        let is_second_order = integrator.stage_ends().len() > 1;
        let order = if is_second_order { integrator.stage_length() * ratio.min(1.0) } else { 1.0 };
        Self(tolerance * ratio.min(ratio * ratio) * order)
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

    fn euler(tolerance: f64, dt: f64) -> Tolerance {
        Tolerance::new(tolerance, dt, Integrator::ImplicitEuler)
    }

    #[test]
    fn stages_have_tighter_tolerances_that_fall_with_the_cube_of_the_time_step() {
        let at = |dt| Tolerance::new(1.0, dt, Integrator::Sdirk2).meters();
        let share = Integrator::Sdirk2.stage_length();
        assert!((at(0.01) - share).abs() < 1e-15);
        assert!((at(0.001) / at(0.01) - 1e-3).abs() < 1e-15);
    }

    #[test]
    fn a_residual_up_to_the_tolerance_ends_and_solves() {
        let tolerance = euler(1e-3, 0.02);
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
        let none = euler(0.0, 0.01);
        assert!(!none.ends(0.0) && none.solves(1.0));
    }

    #[test]
    fn the_tolerance_stands_for_an_acceleration_in_short_steps_and_a_velocity_in_long_ones() {
        assert!((euler(1.0, 0.001).meters() - 0.01).abs() < 1e-15);
        assert!((euler(1.0, 0.05).meters() - 5.0).abs() < 1e-12);
    }
}
