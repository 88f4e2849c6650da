//! One Newton iteration: a linear system, its solution, the line search.

use super::bodies::Answer;
use super::momentum::free_groups;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;
use crate::elements::filter::Filter;
use crate::linear::accuracy::Limits;
use std::ops::Range;

/// Residual at which an inexact linear solve ends, relative to its own right-hand side.
const INEXACT_TOLERANCE: f64 = 0.03;

/// How accurately a linear system is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Accuracy {
    /// To a residual of 0.03: another linearization follows.
    Inexact,
    /// To [`crate::NewtonParams::cg_tolerance`].
    Full,
}

impl Newton<'_> {
    /// Makes one Newton iteration from the iterate to the trial.
    pub(super) fn iterate(&mut self, accuracy: Accuracy) -> Answer<NewtonInfo> {
        self.linearize()?;
        let limits = Limits {
            tolerance: self.params.newton.cg_tolerance,
            own_tolerance: match accuracy {
                Accuracy::Inexact => INEXACT_TOLERANCE,
                Accuracy::Full => 0.0,
            },
            min_scale: self.course.min_scale,
            max_iterations: self.params.newton.cg_max_iterations,
        };
        let solved = self.bodies.solve(self.repulsion.linear(), limits)?;
        if self.course.min_scale == 0.0 {
            self.course.min_scale = solved.scale.min(self.largest_scale());
        }
        self.bodies.restore_momentum(&free_groups(self.model, self.repulsion, self.free))?;
        let mut info = NewtonInfo { iterations: 1, cg: solved.info, ..NewtonInfo::default() };
        self.search_line(&mut info)?;
        self.repulsion.majorizes_friction = info.step_length < 1.0;
        info.max_displacement = self.bodies.distance_from_iterate();
        Ok(info)
    }

    /// The largest squared norm that [`Limits::tolerance`] may be relative to: with a residual of that share of it, the
    /// [`Residual::distance`](crate::Residual::distance) of each component is below half of the tolerance of the time step.
    fn largest_scale(&self) -> f64 {
        let share = 0.5 * self.course.step_tolerance / (self.dt * self.params.newton.cg_tolerance);
        let mass =
            |nodes: &Range<u32>| nodes.clone().map(|n| self.model.node_masses[n as usize]).sum::<f64>();
        let lightest = self.model.components.iter().map(mass).fold(f64::INFINITY, f64::min);
        if share > 0.0 { share * share * lightest } else { f64::INFINITY }
    }

    /// Computes gradient and matrix at the iterate. Springs that have not been prepared get their laws.
    pub fn linearize(&mut self) -> Answer<()> {
        self.bodies.linearize(Filter::new(self.params.newton.hessian_filter, self.is_first))?;
        if self.repulsion.is_empty() {
            return Ok(());
        }
        if std::mem::take(&mut self.course.unprepared) {
            let inertial = self.is_first.then(|| self.bodies.inertial_at_ends());
            let iterate = self.bodies.iterate_at_ends();
            self.repulsion.prepare(self.model, 1.0 / self.dt, self.free, &iterate, inertial.as_deref());
        }
        self.repulsion.linearize(&self.bodies.iterate(), true);
        Ok(())
    }
}
