//! Linear solves of Newton's method: conjugate gradients in single precision, refined in double precision.
//!
//! A product with H reads the whole matrix, and a solve makes a hundred of them or more: at more than some ten
//! thousand nodes it takes as long as memory needs to deliver the matrix. In single precision that is half as
//! long. The residual b - H x at the end is computed in double precision; while it is above the tolerance, a
//! further solve corrects x (iterative refinement, see N. J. Higham, "Accuracy and Stability of Numerical
//! Algorithms", chapter 12). Where single precision gains nothing, the rest is done in double precision.

use super::accuracy::{CgInfo, Limits, MARGIN, MIN_GAIN, subtract_product, unit_factor};
use super::cg::Krylov;
use super::coarse::Coarse;
use super::direct::Direct;
use super::guesses::Guesses;
use super::parts::Parts;
use super::preconditioner::Levels;
use super::system::System;
use bowknot_geometry::Vector;

/// Iterations that the first solves of a time step are expected to take.
const EXPECTED_ITERATIONS: usize = 100;

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
    /// Iterations of the last inexact solve of the time step, and of the last other one.
    expected: [usize; 2],
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
        self.precise = self.levels.direct.is_some();
        self.expected = [EXPECTED_ITERATIONS; 2];
    }

    /// Computes in double precision for the rest of the time step.
    pub fn leave_single_precision(&mut self) {
        self.precise = true;
    }

    /// Sets `z` to the preconditioner of `system`, linearized at positions `x`, times `r`.
    pub fn precondition(&mut self, system: &System<'_>, x: &[Vector], r: &[Vector], z: &mut [Vector]) {
        self.levels.build(system, x, self.expected[1]);
        let (factor, whole) = (unit_factor(r), Parts::whole(r.len()));
        if self.precise {
            self.double.fill_preconditioner(system, &self.levels);
            self.double.begin(&mut self.levels, &whole, r, factor);
            self.double.copy_preconditioned(1.0 / factor, z);
        } else {
            self.single.fill_preconditioner(system, &self.levels);
            self.single.begin(&mut self.levels, &whole, r, factor);
            self.single.copy_preconditioned(1.0 / factor, z);
        }
    }

    /// Squared norms of b in the last solve by part.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// b - H x at the end of the last solve.
    pub fn residual(&self) -> &[Vector] {
        &self.residual
    }

    /// Solves H x = b over the free nodes for the `system`, linearized at `positions`; b and x are zero elsewhere. Each of
    /// the independent `parts` ends by itself.
    ///
    /// The start is the combination of `guesses` with the least energy, or zero if there are none. The
    /// tolerance is relative to b, not to the first residual: a good guess saves iterations and does not
    /// raise the accuracy.
    ///
    /// Where single precision gains nothing, the rest of the time step is done in double precision.
    pub fn solve(
        &mut self,
        &Problem { system, parts, positions, b }: &Problem<'_>,
        guesses: &[&[Vector]],
        limits: &Limits,
        x: &mut [Vector],
    ) -> CgInfo {
        let kind = usize::from(limits.own_tolerance == 0.0);
        let Self { levels, precise, single, double, guesses: start, residual, scales, expected, .. } = self;
        x.fill(Vector::zeros());
        residual.clear();
        residual.extend_from_slice(b);
        let build = |levels: &mut Levels| levels.build(system, positions, expected[kind]);
        let begin = || start.start(system, parts, guesses, x, residual);
        if *precise {
            double.fill(system, levels, build, begin);
        } else {
            single.fill(system, levels, build, begin);
        }

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
            x.fill(Vector::zeros());
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

        factor = unit_factor(residual);
        if *precise {
            double.load(residual, factor);
        } else {
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
        expected[kind] = limits.max_iterations - left;
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
