//! When linear solves end: iterative refinement, as on the CPU (`linear/solver.rs` of the dynamics).
//!
//! A round are iterations of conjugate gradients. After it the residual b - H p is computed; while it is
//! above the tolerance, a further round corrects p from there.

use super::layout::Solve;
use super::places::Newton;
use super::search::Search;
use super::solve::Opposed;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels::cg_tolerance;
use crate::linear::{ConjugateGradients, Recorder};
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{AssemblySprings, CgInfo, NewtonSolve, SolveLimits};
use std::fmt::Debug;
use std::mem::take;

/// Share of the residual that a round must take away at least.
const MIN_GAIN: f64 = 0.5;

/// A residual up to so many times the tolerance is taken where rounding allows no smaller one: to begin again
/// on the CPU would cost more than it gains.
const MAX_EXCESS: f64 = 2.0;

/// The solve without a model.
const NOTHING: NewtonSolve = NewtonSolve {
    info: CgInfo { iterations: 0, residual: 0.0, converged: true },
    scale: 0.0,
    stalled: false,
};

/// Iterations of a batch about which nothing is known, and fewest and most of the others.
pub(super) const FIRST_BATCH: usize = 12;
const MIN_BATCH: usize = 4;
const MAX_BATCH: usize = 128;

/// The first batch of a solve has the most iterations that the last two solves at its place took, the next
/// ones so many times those that are likely to be left; both have so many more. One too few costs a wait, one
/// too many a few dispatches that do nothing.
const CAUTION: f64 = 1.25;
const SPARE: usize = 2;

/// Most blocks whose momenta are read with each batch of iterations; those of more are read once, after the
/// solve.
const MOST_BLOCKS: usize = 128;

/// A solve that goes on.
struct Rounds<'a, E> {
    engine: &'a mut E,
    newton: &'a Newton,
    recorder: &'a Recorder,
    limits: &'a SolveLimits,
    /// Sums of rows of the matrix.
    row_sums: BufferId,
    /// R (d + p) by block after the last batch, or a search from there, if it was read.
    momenta: Option<Vec<u32>>,
    searched: Option<Search>,
    /// Iterations that are left.
    left: usize,
    /// Steps of conjugate gradients that were recorded, starts of rounds after the first included.
    recorded: usize,
    /// Iterations before the round.
    made: usize,
    /// Iterations of the next batch.
    batch: usize,
}

/// Iterations that are likely to be left in a round of which so many are made, from the squared norms at its
/// start and `now`, and the `goal`. None where nothing has decreased.
fn iterations_left(made: usize, [start, now, goal]: [f64; 3]) -> Option<f64> {
    let decrease = (start / now).ln() / made as f64;
    let left = (now / goal).ln() / decrease;
    (decrease > 0.0 && left.is_finite()).then(|| left.max(0.0))
}

impl<E: Engine> Rounds<'_, E> {
    /// Makes a batch of iterations after what was recorded before; they end the round if no more are left.
    fn run(&mut self, mut recording: Recording) -> Result<Solve, GpuError> {
        let batch = self.left.min(self.batch);
        for _ in 0..batch {
            self.recorder.record_iteration(self.recorded, &mut recording);
            self.recorded += 1;
        }
        // Without a patch no stage runs that could end the iterations.
        let is_last = batch == self.left || self.recorder.sizes.patches == 0;
        self.newton.record_end(self.recorder, self.recorded, is_last, self.limits, &mut recording);
        self.recorded += 1;
        let mut wanted = vec![(self.newton.vectors.solve, Solve::WORDS)];
        let searches = self.limits.searches;
        if searches {
            wanted.extend(self.newton.record_search(&mut recording));
        } else if self.newton.blocks.count() <= MOST_BLOCKS {
            wanted.push(self.newton.record_momenta(self.row_sums, &mut recording));
        }
        let mut read = self.engine.run(&recording, &wanted)?;
        let solve = Solve::from_words(&read[0]);
        if searches {
            self.searched = self.newton.search(&mut read[1..]);
        } else {
            self.momenta = (wanted.len() > 1).then(|| read.swap_remove(1));
        }
        self.left = self.limits.max_iterations.saturating_sub(solve.iterations as usize);
        Ok(solve)
    }

    /// Makes rounds until the residual is small enough or they gain too little.
    fn solve(&mut self, recording: Recording) -> Result<NewtonSolve, GpuError> {
        let mut solve = self.run(recording)?;
        let factor = f64::from(solve.factor);
        let squared = |norm: f32| f64::from(norm) / (factor * factor);
        let scale = squared(solve.scale);
        if scale <= 0.0 || !scale.is_finite() {
            let info = CgInfo { iterations: 0, residual: 0.0, converged: scale == 0.0 };
            return Ok(NewtonSolve { info, scale, stalled: false });
        }
        let Self { limits, .. } = *self;
        let relative = scale.max(limits.min_scale);
        let goal = limits.tolerance * limits.tolerance * relative;
        let goal = goal.max(limits.own_tolerance * limits.own_tolerance * scale);
        loop {
            let (before, norm) = (squared(solve.before), squared(solve.norm));
            if solve.ended == 1 {
                // A start that was small enough by its own sums may be above the goal by the product with H.
                let gains =
                    norm <= MIN_GAIN * MIN_GAIN * before || before <= goal || limits.max_iterations == 0;
                let gains_too_little = norm > goal && !gains || !norm.is_finite();
                let stalled =
                    gains_too_little && (norm > MAX_EXCESS * MAX_EXCESS * goal || !norm.is_finite());
                if norm <= goal || gains_too_little || self.left == 0 {
                    let residual = (norm / relative).sqrt();
                    let iterations = solve.iterations as usize;
                    let info = CgInfo { iterations, residual, converged: norm <= goal };
                    return Ok(NewtonSolve { info, scale, stalled });
                }
            }
            if solve.ended == 1 {
                (self.made, self.batch) = (solve.iterations as usize, FIRST_BATCH);
            } else {
                let made = solve.iterations as usize - self.made;
                let norms = [solve.norm, solve.reached, solve.goal].map(f64::from);
                let wanted = |left: f64| ((CAUTION * left).ceil() as usize).saturating_add(SPARE);
                self.batch = iterations_left(made, norms)
                    .map_or(FIRST_BATCH, |left| wanted(left).clamp(MIN_BATCH, MAX_BATCH));
            }
            solve = self.run(Recording::default())?;
        }
    }
}

impl<E: Engine + Debug + Send> ConjugateGradients<E> {
    /// See [`bowknot_dynamics::NewtonBackend::solve`].
    pub(super) fn solve_newton(
        &mut self,
        springs: &AssemblySprings<'_>,
        limits: &SolveLimits,
    ) -> Result<NewtonSolve, GpuError> {
        let Some(newton) = &mut self.newton else { return Ok(NOTHING) };
        newton.is_solved = true;
        newton.momenta = None;
        newton.change_trial();
        newton.spring_sums = newton.blocks.spring_forces(springs.springs);
        let (iterate, quantum) = (newton.vectors.iterate, newton.grid.quantum);
        let mut recording = take(&mut newton.pending);
        newton.record_before(&mut recording);
        self.record_preconditioner(springs, iterate, quantum, &mut recording)?;
        let (Some(newton), Some(recorder), Some(assembly)) =
            (&mut self.newton, &self.recorder, &self.assembly)
        else {
            return Ok(NOTHING);
        };
        let (v, b) = (&newton.vectors, &recorder.buffers);
        if newton.imposes {
            newton.record_imposed(recorder, &mut recording);
        }
        let opposed = Opposed {
            gradient: v.gradient,
            counted: v.free,
            springs: springs.springs.len(),
            imposes: newton.imposes,
        };
        newton.record_right_side(b, &opposed, &mut recording);
        newton.outside(recorder).record_residual(0, &mut recording);
        newton.record_norm(recorder, cg_tolerance::SCALE, 0, limits, &mut recording);
        newton.record_guesses(recorder, &mut recording);
        newton.outside(recorder).record_residual(0, &mut recording);
        newton.record_norm(recorder, cg_tolerance::START, 0, limits, &mut recording);
        let before = newton.iterations.get(&newton.place);
        let mut rounds = Rounds {
            engine: &mut self.engine,
            newton,
            recorder,
            limits,
            row_sums: assembly.buffers.row_sums(),
            momenta: None,
            searched: None,
            left: limits.max_iterations,
            recorded: 0,
            made: 0,
            batch: before.map_or(FIRST_BATCH, |[a, b]| (*a.max(b) + SPARE).clamp(MIN_BATCH, MAX_BATCH)),
        };
        let solved = rounds.solve(recording)?;
        (newton.momenta, newton.searched) = (rounds.momenta, rounds.searched);
        let made = solved.info.iterations;
        let known = newton.iterations.entry(newton.place);
        known.and_modify(|[before, last]| (*before, *last) = (*last, made)).or_insert([made; 2]);
        newton.place += 1;
        Ok(solved)
    }
}

#[cfg(test)]
mod tests {
    use super::iterations_left;

    #[test]
    fn iterations_are_extrapolated_from_a_steady_decrease() {
        // A squared norm that falls to a tenth per iteration: from 1 to 1e-4 in four, to 1e-10 in six more.
        assert!((iterations_left(4, [1.0, 1e-4, 1e-10]).expect("steady") - 6.0).abs() < 1e-9);
        assert_eq!(iterations_left(4, [1.0, 1e-4, 1e-3]), Some(0.0));
        for [start, now] in [[1.0, 1.0], [1.0, 2.0], [f64::NAN, 1.0], [1.0, f64::INFINITY]] {
            assert_eq!(iterations_left(4, [start, now, 1e-10]), None);
        }
        assert_eq!(iterations_left(4, [1.0, 1e-4, 0.0]), None);
        assert_eq!(iterations_left(0, [1.0, 1.0, 1e-4]), None);
    }
}
