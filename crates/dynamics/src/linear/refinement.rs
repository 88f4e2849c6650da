//! A linear solve by a backend in single precision, refined in double precision.

use super::accuracy::{CgInfo, Limits, MARGIN, MIN_GAIN, unit_factor};
use super::backend::LinearBackend;
use super::failure::LinearBackendError;
use super::guesses::Guesses;
use super::parts::Parts;
use super::system::System;
use bowknot_geometry::Vector;

/// The backend and the buffers of a refinement.
#[derive(Debug)]
pub(super) struct Refinement {
    pub backend: Box<dyn LinearBackend>,
    guesses: Guesses,
}

/// How a solve ended.
#[derive(Debug)]
pub(super) struct Refined {
    pub info: CgInfo,
    /// Squared norm of b.
    pub scale: f64,
    /// Whether a round in single precision gained too little: x is then the best so far, above the tolerance.
    pub stalled: bool,
}

impl Refinement {
    pub fn new(backend: Box<dyn LinearBackend>) -> Self {
        Self { backend, guesses: Guesses::default() }
    }

    /// Solves H x = b, as [`super::solver::LinearSolver::solve`] does. `residual` becomes b - H x, in the precision
    /// of the matrix.
    pub fn solve(
        &mut self,
        system: &System<'_>,
        b: &[Vector],
        guesses: &[&[Vector]],
        limits: &Limits,
        x: &mut [Vector],
        residual: &mut Vec<Vector>,
    ) -> Result<Refined, LinearBackendError> {
        residual.clear();
        residual.extend_from_slice(b);
        let mut factor = unit_factor(b);
        let scale = self.backend.begin(b, factor)? / (factor * factor);
        if scale <= 0.0 || !scale.is_finite() {
            let info = CgInfo { iterations: 0, residual: 0.0, converged: scale == 0.0 };
            return Ok(Refined { info, scale, stalled: false });
        }
        let relative = scale.max(limits.min_scale_of_whole());
        let goal = limits.tolerance * limits.tolerance * relative;
        let goal = goal.max(limits.own_tolerance * limits.own_tolerance * scale);

        self.guesses.start(system, &Parts::whole(b.len()), guesses, x, residual);
        let mut norm = scale;
        if !guesses.is_empty() {
            self.subtract_product(system, x, b, residual)?;
            factor = unit_factor(residual);
            norm = self.backend.begin(residual, factor)? / (factor * factor);
        }
        let mut left = limits.max_iterations;
        let mut stalled = false;
        while norm > goal && left > 0 && norm.is_finite() && !stalled {
            let before = norm;
            let goal_here = MARGIN * MARGIN * goal * factor * factor;
            left -= self.backend.iterate(goal_here, left, 1.0 / factor, x)?.min(left);
            self.subtract_product(system, x, b, residual)?;
            factor = unit_factor(residual);
            norm = self.backend.begin(residual, factor)? / (factor * factor);
            stalled = norm > goal && (norm > MIN_GAIN * MIN_GAIN * before || !norm.is_finite());
        }
        let iterations = limits.max_iterations - left;
        let info = CgInfo { iterations, residual: (norm / relative).sqrt(), converged: norm <= goal };
        Ok(Refined { info, scale, stalled })
    }

    /// Sets `residual` to b - H x.
    fn subtract_product(
        &mut self,
        system: &System<'_>,
        x: &[Vector],
        b: &[Vector],
        residual: &mut [Vector],
    ) -> Result<(), LinearBackendError> {
        system.multiply(x, residual);
        residual.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
        Ok(())
    }
}
