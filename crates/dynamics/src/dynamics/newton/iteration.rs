//! One Newton iteration: a linear system, its solution, the line search.

use super::bodies::Answer;
use super::momentum::free_groups;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;
use crate::elements::filter::Filter;
use crate::linear::accuracy::Limits;
use crate::linear::parts::Parts;

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
        let springs = self.repulsion.linear();
        let parts = Parts::new(&self.model.components, springs);
        let limits = Limits {
            tolerance: self.params.newton.cg_tolerance,
            own_tolerance: match accuracy {
                Accuracy::Inexact => INEXACT_TOLERANCE,
                Accuracy::Full => 0.0,
            },
            min_scales: self.min_scales(&parts),
            max_iterations: self.params.newton.cg_max_iterations,
        };
        let groups = free_groups(self.model, self.repulsion, self.free);
        let solved = self.bodies.solve(springs, &parts, &limits, &groups)?;
        self.note_scales(&parts, &solved.scales);
        let mut info = NewtonInfo { iterations: 1, cg: solved.info, ..NewtonInfo::default() };
        self.search_line(&mut info)?;
        self.repulsion.majorizes_friction = info.step_length < 1.0;
        info.max_displacement = self.bodies.distance_from_iterate();
        Ok(info)
    }

    /// The largest of the scales of each part's components, and no more than [`Self::largest_scales`].
    fn min_scales(&self, parts: &Parts) -> Vec<f64> {
        let mut scales = vec![0.0f64; parts.count()];
        for (&part, &scale) in parts.of_components().iter().zip(&self.course.scales) {
            scales[part as usize] = scales[part as usize].max(scale);
        }
        scales
            .iter_mut()
            .zip(self.largest_scales(parts))
            .for_each(|(scale, largest)| *scale = scale.min(largest));
        scales
    }

    /// Notes the squared norms of parts as those of their components, where these have none yet.
    fn note_scales(&mut self, parts: &Parts, norms: &[f64]) {
        self.course.scales.resize(parts.of_components().len(), 0.0);
        if !self.course.scales.contains(&0.0) {
            return;
        }
        let largest = self.largest_scales(parts);
        for (scale, &part) in self.course.scales.iter_mut().zip(parts.of_components()) {
            if *scale == 0.0 {
                *scale = norms[part as usize].min(largest[part as usize]);
            }
        }
    }

    /// The largest squared norms that [`Limits::tolerance`] may be relative to: with a residual of that share
    /// of it, the [`Residual::distance`](crate::Residual::distance) of each component of the part is below
    /// half of the tolerance of the time step.
    fn largest_scales(&self, parts: &Parts) -> Vec<f64> {
        let share = 0.5 * self.course.step_tolerance / (self.dt * self.params.newton.cg_tolerance);
        let mut lightest = vec![f64::INFINITY; parts.count()];
        for (&part, nodes) in parts.of_components().iter().zip(&self.model.components) {
            let mass = self.model.component_masses[nodes.start as usize];
            lightest[part as usize] = lightest[part as usize].min(mass);
        }
        let largest = |mass: f64| if share > 0.0 { share * share * mass } else { f64::INFINITY };
        lightest.into_iter().map(largest).collect()
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
