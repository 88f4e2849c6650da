//! One Newton iteration: a linear system, its solution, the line search.

use super::momentum::{Inertia, restore_momentum};
use super::state::{Newton, negate_forces};
use crate::dynamics::info::NewtonInfo;
use crate::linear::accuracy::{CgInfo, Limits};
use crate::linear::system::System;
use bowknot_geometry::Vector;

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
    /// Makes one Newton iteration from `work.x` to `work.trial`.
    pub(super) fn iterate(&mut self, accuracy: Accuracy) -> NewtonInfo {
        self.linearize();
        let Self { params, step, work, .. } = self;
        // There are two guesses: the way to the positions where inertia leads, and the way to the last
        // target. In free flight the first is all but exact, near the solution of a step the second.
        // Corrections use them as well: what is still missing along them is what conjugate gradients find
        // last.
        let guess_count = 1 + usize::from(step.last_target.is_some());
        for (guess, target) in work.guesses.iter_mut().zip([Some(&step.inertial), step.last_target.as_ref()])
        {
            let Some(target) = target else { continue };
            for (node, guess) in guess.iter_mut().enumerate() {
                *guess = if work.free[node] { target[node] - work.x[node] } else { Vector::zeros() };
            }
        }
        let limits = Limits {
            tolerance: params.newton.cg_tolerance,
            own_tolerance: match accuracy {
                Accuracy::Inexact => INEXACT_TOLERANCE,
                Accuracy::Full => 0.0,
            },
            min_scale: work.min_scale,
            max_iterations: params.newton.cg_max_iterations,
        };
        let solved = self.solve_assembled(guess_count, limits);
        let cg = solved.unwrap_or_else(|| {
            self.linearize_on_cpu();
            self.solve_system(guess_count, limits)
        });
        let mut info = NewtonInfo { iterations: 1, cg, ..NewtonInfo::default() };
        let Self { model, params, repulsion, step, work } = self;
        if work.min_scale == 0.0 {
            work.min_scale = work.solver.scale();
        }
        let inertia = Inertia {
            per_mass: 1.0 / (step.dt * step.dt) + params.environment.air_drag / step.dt,
            drag: step.drag.as_ref(),
            rate: 1.0 / step.dt,
        };
        restore_momentum(model, repulsion, &inertia, &work.free, work.solver.residual(), &mut work.step);
        self.search_line(&mut info);
        info.max_displacement = largest_distance(&self.work.trial, &self.work.x, &self.work.free);
        info
    }

    /// Solves the system whose matrix is on the CPU.
    fn solve_system(&mut self, guesses: usize, limits: Limits) -> CgInfo {
        let Self { model, repulsion, step, work, .. } = self;
        // b = -(g + H p) over free nodes, with p the imposed displacements of the prescribed nodes.
        let springs = repulsion.linear();
        let system = System {
            pattern: &model.pattern,
            values: &work.values,
            scalar: &step.scalar,
            springs: (!springs.is_empty()).then_some(springs),
            free: &work.free,
        };
        if work.imposed.iter().any(|p| *p != Vector::zeros()) {
            system.multiply(&work.imposed, &mut work.right_side);
        } else {
            work.right_side.fill(Vector::zeros());
        }
        negate_forces(&mut work.right_side, &work.gradient, &work.free);
        let [inertia, last] = &work.guesses;
        let guesses: &[&[Vector]] = &[last.as_slice(), inertia.as_slice()][2 - guesses..];
        work.solver.solve(&system, &work.x, &work.right_side, guesses, limits, &mut work.step)
    }
}

/// Largest |y - x| over free nodes [m].
pub(super) fn largest_distance(y: &[Vector], x: &[Vector], free: &[bool]) -> f64 {
    let distance = |((y, x), _): ((&Vector, &Vector), &bool)| (y - x).norm();
    y.iter().zip(x).zip(free).filter(|(_, free)| **free).map(distance).fold(0.0, f64::max)
}
