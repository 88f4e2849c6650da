//! Results of Newton iterations.

use crate::linear::accuracy::CgInfo;
#[cfg(feature = "serde")]
use serde::Serialize;

/// Statistics of one target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct NewtonInfo {
    /// The linear solves: the sum of their iterations, the last residual, whether all converged.
    pub cg: CgInfo,
    /// Number of Newton iterations: 1 and the correcting ones.
    pub iterations: usize,
    /// Share of the last Newton step that the line search kept, in (0, 1].
    pub step_length: f64,
    /// Ratio of the last step's decrease of the potential to the decrease that the quadratic model predicted,
    /// or its inverse if that is smaller, or `step_length` if that is smaller still [1].
    pub reduction_ratio: f64,
    /// Incremental potential at x, with prescribed vertices at their keyframes [J].
    pub energy_before: f64,
    /// Incremental potential at y [J].
    pub energy_after: f64,
    /// Largest |y - x| over free vertices [m].
    pub max_displacement: f64,
}

impl NewtonInfo {
    /// Adds the next iteration of the same target.
    pub(super) fn add(&mut self, next: &Self) {
        self.cg.iterations += next.cg.iterations;
        self.cg.residual = next.cg.residual;
        self.cg.converged &= next.cg.converged;
        self.iterations += next.iterations;
        self.step_length = next.step_length;
        self.reduction_ratio = next.reduction_ratio;
        self.energy_after = next.energy_after;
    }

    /// Decrease of the potential [J].
    pub(super) fn decrease(&self) -> f64 {
        self.energy_before - self.energy_after
    }
}

/// How far a state is from a solution of the time step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct Residual {
    /// Root of the sum of squares of the forces on free nodes that are out of balance [N].
    pub force: f64,
    /// These forces as a distance [m]: the largest sqrt(dt^2 r . P r / M) over connected components, with r
    /// the forces, P the preconditioner of the Newton system without contacts, and M the mass of the
    /// component. As H is at least M / dt^2, this is an upper bound of the root mean square distance,
    /// weighted by mass, to the state in which the forces balance, up to the quality of P.
    pub distance: f64,
    /// A vertex of the component with this distance; none if no forces count.
    pub vertex: Option<u32>,
}
