//! Linear solves of Newton's method: conjugate gradients in single precision, refined in double precision.
//!
//! A product with H reads the whole matrix, and a solve makes a hundred of them or more: at more than some ten
//! thousand nodes it takes as long as memory needs to deliver the matrix. In single precision that is half as
//! long. The residual b - H x at the end is computed in double precision; while it is above the tolerance, a
//! further solve corrects x (iterative refinement, see N. J. Higham, "Accuracy and Stability of Numerical
//! Algorithms", chapter 12). Where single precision gains nothing, the rest is done in double precision.

use super::accuracy::{CgInfo, Limits, MARGIN, MIN_GAIN, subtract_product, unit_factor};
use super::assembly::ElementModel;
use super::backend::LinearBackend;
use super::cg::Krylov;
use super::coarse::Coarse;
use super::direct::Direct;
use super::failure::LinearBackendError;
use super::guesses::Guesses;
use super::parts::Parts;
use super::preconditioner::Levels;
use super::refinement::Refinement;
use super::system::System;
use crate::dynamics::NewtonBackend;
use bowknot_geometry::Vector;
use std::ops::Range;

/// A linear system H x = b.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'a> {
    pub system: &'a System<'a>,
    /// Its independent parts.
    pub parts: &'a Parts,
    /// Where H was linearized [m].
    pub positions: &'a [Vector],
    /// Zero at nodes that are not free.
    pub b: &'a [Vector],
}

/// Solves systems and measures residuals.
#[derive(Debug, Default)]
pub(crate) struct LinearSolver {
    levels: Levels,
    /// Whether single precision is left out: for models with strands, whose stiffness is up to 10^7 times
    /// their inertia, and for the rest of a time step in which it was not enough.
    precise: bool,
    single: Krylov<f32>,
    double: Krylov<f64>,
    guesses: Guesses,
    /// Solves in place of `single`, with the patches of nodes for its preconditioner.
    backend: Option<(Refinement, Vec<Range<u32>>)>,
    /// Whether the backend does the whole of Newton iterations for this model.
    computes_model: bool,
    /// Whether the backend is left out for the rest of the time step.
    on_cpu: bool,
    /// What the backend failed of.
    failure: Option<String>,
    /// b - H x [N].
    residual: Vec<Vector>,
    /// Squared norms of b by part.
    scales: Vec<f64>,
}

impl LinearSolver {
    /// Block-Jacobi, replaced by `direct` at the nodes of strands, plus `coarse`.
    pub fn new(direct: Option<Direct>, coarse: Option<Coarse>) -> Self {
        let precise = direct.is_some();
        Self { levels: Levels { direct, coarse }, precise, ..Self::default() }
    }

    /// Forgets what depends on the time step before.
    pub fn begin_step(&mut self) {
        self.on_cpu = false;
        self.precise = self.levels.direct.is_some();
    }

    /// Lets a backend solve in single precision; None for the CPU. If it can, it does the whole of Newton iterations.
    pub fn set_backend(
        &mut self,
        backend: Option<Box<dyn LinearBackend>>,
        patches: Vec<Range<u32>>,
        model: impl FnOnce() -> ElementModel,
    ) {
        self.backend = backend.map(|backend| (Refinement::new(backend), patches));
        self.failure = None;
        self.computes_model = false;
        let newton = self.backend.as_mut().and_then(|(refinement, _)| refinement.backend.newton());
        match newton.map(|newton| newton.set_model(&model())) {
            Some(Ok(computes)) => self.computes_model = computes,
            Some(Err(error)) => self.fail(&error),
            None => {}
        }
    }

    /// What does Newton iterations, unless it is the CPU.
    pub fn newton(&mut self) -> Option<&mut dyn NewtonBackend> {
        let backend = self.backend.as_mut().filter(|_| self.computes_model && !self.on_cpu);
        backend.and_then(|(refinement, _)| refinement.backend.newton())
    }

    /// Leaves the backend out for the rest of the time step, and computes in double precision.
    pub fn leave_backend_out(&mut self) {
        (self.on_cpu, self.precise) = (true, true);
    }

    fn fail(&mut self, error: &LinearBackendError) {
        self.failure = Some(error.to_string());
        self.on_cpu = true;
    }

    /// Takes the backend away, if there is one.
    pub fn take_backend(&mut self) -> Option<Box<dyn LinearBackend>> {
        self.backend.take().map(|(refinement, _)| refinement.backend)
    }

    /// The backend, if there is one.
    pub fn backend(&self) -> Option<&dyn LinearBackend> {
        self.backend.as_ref().map(|(refinement, _)| &*refinement.backend)
    }

    /// What the backend has failed of since the last call.
    pub fn take_failure(&mut self) -> Option<String> {
        self.failure.take()
    }

    /// Builds the preconditioner of the CPU for `system`, linearized at positions `x`.
    fn prepare(&mut self, system: &System<'_>, x: &[Vector]) {
        self.levels.build(system, x);
        if self.precise {
            self.double.fill_preconditioner(system, &self.levels);
        } else {
            self.single.fill_preconditioner(system, &self.levels);
        }
    }

    /// Sets `z` to the preconditioner of `system`, linearized at positions `x`, times `r`.
    pub fn precondition(&mut self, system: &System<'_>, x: &[Vector], r: &[Vector], z: &mut [Vector]) {
        self.prepare(system, x);
        let (factor, whole) = (unit_factor(r), Parts::whole(r.len()));
        if self.precise {
            self.double.begin(&mut self.levels, &whole, r, factor);
            self.double.copy_preconditioned(1.0 / factor, z);
        } else {
            self.single.begin(&mut self.levels, &whole, r, factor);
            self.single.copy_preconditioned(1.0 / factor, z);
        }
    }

    /// Squared norms of b in the last solve by part; all are that of the whole if a backend has solved.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// b - H x at the end of the last solve.
    pub fn residual(&self) -> &[Vector] {
        &self.residual
    }

    /// Solves H x = b over the free nodes for the `system`, linearized at `positions`; b and x are zero elsewhere. On the CPU
    /// each of the independent `parts` ends by itself; a backend solves them as one.
    ///
    /// The start is the combination of `guesses` with the least energy, or zero if there are none. The
    /// tolerance is relative to b, not to the first residual: a good guess saves iterations and does not
    /// raise the accuracy.
    ///
    /// If the backend fails, the CPU solves and [`Self::take_failure`] tells. Where single precision gains nothing,
    /// the CPU does the rest of the time step in double precision.
    pub fn solve(
        &mut self,
        problem: &Problem<'_>,
        guesses: &[&[Vector]],
        limits: &Limits,
        x: &mut [Vector],
    ) -> CgInfo {
        let Problem { system, parts, positions, b } = problem;
        if let Some((refinement, patches)) = self.backend.as_mut().filter(|_| !self.on_cpu) {
            x.fill(Vector::zeros());
            let prepared = refinement.backend.prepare(&system.for_backend(positions, patches));
            let solved =
                prepared.and_then(|()| refinement.solve(system, b, guesses, limits, x, &mut self.residual));
            match solved {
                Ok(refined) if !refined.stalled => {
                    self.scales = vec![refined.scale; parts.count()];
                    return refined.info;
                }
                Ok(refined) => {
                    tracing::debug!("single precision is not enough for the linear solves of a time step");
                    let start = x.to_vec();
                    self.leave_backend_out();
                    let mut info = self.solve_on_cpu(problem, &[&start], limits, x);
                    info.iterations += refined.info.iterations;
                    return info;
                }
                Err(error) => self.fail(&error),
            }
        }
        self.solve_on_cpu(problem, guesses, limits, x)
    }

    fn solve_on_cpu(
        &mut self,
        &Problem { system, parts, positions, b }: &Problem<'_>,
        guesses: &[&[Vector]],
        limits: &Limits,
        x: &mut [Vector],
    ) -> CgInfo {
        self.prepare(system, positions);
        x.fill(Vector::zeros());
        self.residual.clear();
        self.residual.extend_from_slice(b);
        let Self { levels, precise, single, double, guesses: start, residual, scales, .. } = self;

        let mut factor = unit_factor(b);
        let norms = if *precise {
            double.begin(levels, parts, b, factor)
        } else {
            single.begin(levels, parts, b, factor)
        };
        let mut norms = unscaled(norms, factor);
        if !norms.iter().all(|norm| *norm >= 0.0 && norm.is_finite()) || norms.iter().all(|norm| *norm == 0.0)
        {
            scales.clear();
            scales.resize(parts.count(), 0.0);
            return CgInfo { iterations: 0, residual: 0.0, converged: norms.iter().all(|norm| *norm == 0.0) };
        }
        scales.clone_from(&norms);
        let relative: Vec<f64> =
            norms.iter().zip(&limits.min_scales).map(|(norm, min)| norm.max(*min)).collect();
        let goal = |(relative, norm): (&f64, &f64)| {
            let enough = limits.own_tolerance * limits.own_tolerance * norm;
            (limits.tolerance * limits.tolerance * relative).max(enough)
        };
        let goals: Vec<f64> = relative.iter().zip(&norms).map(goal).collect();
        let scaled = |share: f64, factor: f64| -> Vec<f64> {
            goals.iter().map(|goal| share * goal * factor * factor).collect()
        };
        let mut left = limits.max_iterations;

        start.start(system, parts, guesses, x, residual);
        factor = unit_factor(residual);
        if *precise {
            double.fill_operator(system);
            double.load(residual, factor);
        } else {
            single.fill_operator(system);
            single.load(residual, factor);
            loop {
                let before = norms;
                left -= single.iterate(system, levels, parts, &scaled(MARGIN * MARGIN, factor), left).0;
                single.add_solution(1.0 / factor, x);
                subtract_product(system, x, b, residual);
                factor = unit_factor(residual);
                norms = unscaled(single.begin(levels, parts, residual, factor), factor);
                let ended = |(norm, goal): (&f64, &f64)| norm <= goal || !norm.is_finite();
                if norms.iter().zip(&goals).all(ended) || left == 0 {
                    break;
                }
                let stalls = |((norm, before), goal): ((&f64, &f64), &f64)| {
                    norm > goal && *norm > MIN_GAIN * MIN_GAIN * before
                };
                if norms.iter().zip(&before).zip(&goals).any(stalls) {
                    tracing::debug!("single precision is not enough for the linear solves of a time step");
                    *precise = true;
                    double.fill_preconditioner(system, levels);
                    double.fill_operator(system);
                    double.load(residual, factor);
                    break;
                }
            }
        }
        if *precise {
            let (iterations, squared) = double.iterate(system, levels, parts, &scaled(1.0, factor), left);
            left -= iterations;
            norms = unscaled(squared, factor);
            double.add_solution(1.0 / factor, x);
            double.copy_residual(1.0 / factor, residual);
        }
        let shares = norms.iter().zip(&relative).filter(|(_, relative)| **relative > 0.0);
        let largest = shares.map(|(norm, relative)| norm / relative).fold(0.0, f64::max);
        CgInfo {
            iterations: limits.max_iterations - left,
            residual: largest.sqrt(),
            converged: norms.iter().zip(&goals).all(|(norm, goal)| norm <= goal),
        }
    }
}

/// Squared norms of vectors that were multiplied by a factor.
fn unscaled(norms: Vec<f64>, factor: f64) -> Vec<f64> {
    norms.into_iter().map(|norm| norm / (factor * factor)).collect()
}
