//! The state of a spring between two solves, and Coulomb's law.
//!
//! With the slip u since the start of the time step, the stiffness G of sticking, and the friction tau at the
//! start, friction is tau - G u, cut to the length of the bound: the return mapping of perfect plasticity. It
//! is minus the derivative of the energy
//!
//! ```text
//! sticking, |tau - G u| <= bound    |tau - G u|^2 / (2 G)
//! sliding                           bound (|tau - G u| - bound / 2) / G
//! ```
//!
//! a function of Huber's form. The bound is mu times the normal force at the end of the last Newton step: if
//! it followed the gap, the matrix would not be symmetric, and there would be no energy.

use super::law::{NormalLaw, Push};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// The part of a spring that changes from solve to solve.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SpringState {
    /// The normal force.
    pub law: NormalLaw,
    /// Whether anything can act: some vertex is free.
    pub acts: bool,
    /// Whether the contact is open, but inertia closes it: the first solve takes it for closed.
    pub predicted: bool,
    /// Stiffness G of sticking [N/m].
    pub grip: f64,
    /// Friction at the start of the time step [N].
    pub tau: Vector,
    /// The bound of friction [N]: mu times the normal force.
    pub bound: f64,
    /// Slip where inertia leads, for the first solve of a time step: friction is linearized there.
    pub slip_ahead: Option<Vector>,
    /// Gap [m], normal force [N] and stiffness [N/m] of the last linearization; zeros if nothing acts.
    pub model: [f64; 3],
}

/// Friction after a slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rub {
    /// [N].
    pub force: Vector,
    /// Energy that has the force as its negative gradient [J].
    pub energy: f64,
    /// Length of the trial force [N] if it slides.
    pub sliding: Option<f64>,
}

/// Friction linearized at a slip.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearRub {
    /// The slip [m].
    pub at: Vector,
    /// Friction there [N].
    pub force: Vector,
    /// Minus the derivative of friction by the slip, or a majorizer of it [N/m].
    pub matrix: Matrix3<f64>,
}

impl SpringState {
    /// Whether it pushed at the last linearization.
    pub fn pushes(&self) -> bool {
        self.model[2] > 0.0
    }

    /// The normal force at a gap.
    pub fn push(&self, gap: f64) -> Push {
        if self.predicted { self.law.predicted(gap) } else { self.law.at(gap) }
    }

    /// Energy that has the normal force as its negative derivative [J].
    pub fn push_energy(&self, gap: f64) -> f64 {
        if self.predicted { self.law.predicted_energy(gap) } else { self.law.energy(gap) }
    }

    /// Friction linearized at a slip `at`; `across` projects on the tangent plane. Where it slides, friction
    /// is not stiff in its own direction; with `majorizes` it counts as stiff as across it.
    pub fn linear_rub(&self, at: Vector, across: &Matrix3<f64>, majorizes: bool) -> LinearRub {
        let rub = self.rub(&at, self.bound);
        let matrix = match rub.sliding {
            None => across * self.grip,
            Some(size) if majorizes => across * (self.grip * self.bound / size),
            Some(size) => {
                let d = rub.force / self.bound;
                (across - d * d.transpose()) * (self.grip * self.bound / size)
            }
        };
        LinearRub { at, force: rub.force, matrix }
    }

    /// Coulomb's law after a `slip`, with a `bound` [N].
    pub fn rub(&self, slip: &Vector, bound: f64) -> Rub {
        if bound <= 0.0 || self.grip <= 0.0 {
            return Rub { force: Vector::zeros(), energy: 0.0, sliding: None };
        }
        let trial = self.tau - slip * self.grip;
        let size = trial.norm();
        if size <= bound {
            Rub { force: trial, energy: 0.5 * size * size / self.grip, sliding: None }
        } else {
            let energy = bound * (size - 0.5 * bound) / self.grip;
            Rub { force: trial * (bound / size), energy, sliding: Some(size) }
        }
    }
}
