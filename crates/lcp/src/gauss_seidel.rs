//! Projected Gauss-Seidel: one row after the other, or color by color with the rows of a color in
//! parallel.
//!
//! Both visit the rows in the order of the schedule and compute each row in the same way. Rows of a color
//! share no node that moves, so both give the same bits for any number of threads.

use crate::error::LcpError;
use crate::info::LcpInfo;
use crate::kernels::{FrictionRule, relax_friction, relax_limit, relax_row};
use crate::params::LcpParams;
use crate::problem::LcpProblem;
use crate::schedule::Schedule;
use crate::slots::{Slots, atomics, cells};
use crate::state::LcpState;
use crate::team::{self, Phases};
use crate::vector::{TangentVector, Vector};
use bowknot_errors::Parameters;
use std::ops::Range;

/// Rows that a thread takes at once: so many that the cost of the counter (50 ns) is small, and so few that
/// threads share a color of some hundred rows evenly.
const ROW_CHUNK: usize = 64;
/// Distance limits that a thread takes at once; they are cheaper than rows.
const LIMIT_CHUNK: usize = 128;
/// With fewer constraints than this a sweep takes less time than waking a thread.
const PARALLEL_MIN: usize = 1024;

/// One sweep in the order of the schedules, on this thread.
///
/// # Errors
/// [`LcpError::Length`] if the state does not fit the problem; [`LcpError::Parameters`].
pub fn sweep_serial(
    problem: &LcpProblem<'_>,
    state: &mut LcpState<'_>,
    params: &LcpParams,
) -> Result<(), LcpError> {
    params.validate()?;
    state.check(problem)?;
    serial::<false>(problem, state, params, 1);
    Ok(())
}

/// Sweeps in the order of the schedules, on this thread.
///
/// # Errors
/// [`LcpError::Length`] if the state does not fit the problem; [`LcpError::Parameters`];
/// [`LcpError::NotConverged`] if [`LcpParams::tolerance`] asks for more than `max_sweeps` give.
pub fn solve_serial(
    problem: &LcpProblem<'_>,
    state: &mut LcpState<'_>,
    params: &LcpParams,
) -> Result<LcpInfo, LcpError> {
    params.validate()?;
    state.check(problem)?;
    repeat(params, |residual, sweeps| {
        if residual {
            serial::<true>(problem, state, params, sweeps)
        } else {
            serial::<false>(problem, state, params, sweeps)
        }
    })
}

/// One sweep, the rows of a color in parallel on the threads of the current rayon pool. The same bits as
/// [`sweep_serial`] if the colors are valid ([`crate::validate_colors`]).
///
/// # Errors
/// [`LcpError::Length`] if the state does not fit the problem; [`LcpError::Parameters`].
pub fn sweep_colored(
    problem: &LcpProblem<'_>,
    state: &mut LcpState<'_>,
    params: &LcpParams,
) -> Result<(), LcpError> {
    GaussSeidel::default().sweep(problem, state, params)
}

/// Sweeps, the rows of a color in parallel on the threads of the current rayon pool. The same bits as
/// [`solve_serial`] if the colors are valid ([`crate::validate_colors`]).
///
/// # Errors
/// As [`solve_serial`].
pub fn solve_colored(
    problem: &LcpProblem<'_>,
    state: &mut LcpState<'_>,
    params: &LcpParams,
) -> Result<LcpInfo, LcpError> {
    GaussSeidel::default().solve(problem, state, params)
}

/// The solver of [`sweep_colored`] and [`solve_colored`] with its scratch memory, for callers that sweep
/// often: it then allocates nothing. It may be dropped at any time.
#[derive(Clone, Debug, Default)]
pub struct GaussSeidel {
    /// The phases of one sweep.
    phases: Vec<Phase>,
}

impl GaussSeidel {
    /// A solver with empty scratch memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// One sweep, see [`sweep_colored`].
    ///
    /// # Errors
    /// As [`sweep_colored`].
    pub fn sweep(
        &mut self,
        problem: &LcpProblem<'_>,
        state: &mut LcpState<'_>,
        params: &LcpParams,
    ) -> Result<(), LcpError> {
        params.validate()?;
        state.check(problem)?;
        self.colored::<false>(problem, state, params, 1);
        Ok(())
    }

    /// Sweeps, see [`solve_colored`].
    ///
    /// # Errors
    /// As [`solve_serial`].
    pub fn solve(
        &mut self,
        problem: &LcpProblem<'_>,
        state: &mut LcpState<'_>,
        params: &LcpParams,
    ) -> Result<LcpInfo, LcpError> {
        params.validate()?;
        state.check(problem)?;
        repeat(params, |residual, sweeps| {
            if residual {
                self.colored::<true>(problem, state, params, sweeps)
            } else {
                self.colored::<false>(problem, state, params, sweeps)
            }
        })
    }

    fn colored<const RESIDUAL: bool>(
        &mut self,
        problem: &LcpProblem<'_>,
        state: &mut LcpState<'_>,
        params: &LcpParams,
        sweeps: u32,
    ) -> f64 {
        let rows = problem.distance_limits().swept() + problem.rows().swept() + problem.friction().swept();
        let threads = rayon::current_num_threads();
        if threads == 1 || rows < PARALLEL_MIN || sweeps == 0 {
            return serial::<RESIDUAL>(problem, state, params, sweeps);
        }
        list_phases(problem, &mut self.phases);
        // Nothing to share: one thread would do everything, and the others would wait.
        if self.phases.iter().all(|phase| phase.end - phase.begin <= phase.chunk) {
            return serial::<RESIDUAL>(problem, state, params, sweeps);
        }
        let views = (
            atomics(state.y),
            atomics(state.lambda),
            atomics(state.limit_multipliers),
            atomics(state.friction),
        );
        let (Some(y), Some(lambda), Some(limit_multipliers), Some(friction)) = views else {
            return serial::<RESIDUAL>(problem, state, params, sweeps);
        };
        let sweep = Sweep::<_, _, _, _, RESIDUAL> {
            problem,
            params,
            phases: &self.phases,
            sweeps: sweeps as usize,
            y,
            lambda,
            limit_multipliers,
            friction,
        };
        team::run(&sweep, threads)
    }
}

/// Repeats `sweep(whether to compute the residual, number of sweeps)`, which returns the residual of the last
/// sweep. It makes as few calls, and computes as few residuals, as the tolerance allows.
fn repeat(params: &LcpParams, mut sweep: impl FnMut(bool, u32) -> f64) -> Result<LcpInfo, LcpError> {
    let sweeps = params.max_sweeps;
    let Some(tolerance) = params.tolerance else {
        sweep(false, sweeps.saturating_sub(1));
        return Ok(LcpInfo { sweeps, residual: sweep(true, sweeps.min(1)) });
    };
    let mut residual = f64::INFINITY;
    for sweeps in 1..=sweeps {
        residual = sweep(true, 1);
        if residual <= tolerance {
            return Ok(LcpInfo { sweeps, residual });
        }
    }
    Err(LcpError::NotConverged { sweeps, residual })
}

fn serial<const RESIDUAL: bool>(
    problem: &LcpProblem<'_>,
    state: &mut LcpState<'_>,
    params: &LcpParams,
    sweeps: u32,
) -> f64 {
    let sweep = Sweep::<_, _, _, _, RESIDUAL> {
        problem,
        params,
        phases: &[],
        sweeps: sweeps as usize,
        y: cells(state.y),
        lambda: cells(state.lambda),
        limit_multipliers: cells(state.limit_multipliers),
        friction: cells(state.friction),
    };
    let mut residual = 0.0;
    for _ in 0..sweeps {
        for kind in [ConstraintKind::Limit, ConstraintKind::Row, ConstraintKind::Friction] {
            sweep.run(kind, 0, sweep.swept(kind), &mut residual);
        }
    }
    residual
}

/// The larger of two numbers in one instruction; `f64::max` takes five, in a chain through all rows.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The types of constraints, in the order of a sweep.
#[derive(Clone, Copy, Debug)]
enum ConstraintKind {
    Limit,
    Row,
    Friction,
}

/// Sweeps over views of the state.
struct Sweep<'a, Y, L, F, T, const RESIDUAL: bool> {
    problem: &'a LcpProblem<'a>,
    params: &'a LcpParams,
    /// The phases of one sweep, where threads share it.
    phases: &'a [Phase],
    sweeps: usize,
    y: Y,
    lambda: L,
    limit_multipliers: F,
    friction: T,
}

impl<Y, L, F, T, const RESIDUAL: bool> Sweep<'_, Y, L, F, T, RESIDUAL>
where
    Y: Slots<Vector>,
    L: Slots<f64>,
    F: Slots<Vector>,
    T: Slots<TangentVector>,
{
    fn schedule(&self, kind: ConstraintKind) -> Schedule<'_> {
        match kind {
            ConstraintKind::Limit => self.problem.distance_limits().schedule,
            ConstraintKind::Row => self.problem.rows().schedule,
            ConstraintKind::Friction => self.problem.friction().schedule,
        }
    }

    fn swept(&self, kind: ConstraintKind) -> usize {
        match kind {
            ConstraintKind::Limit => self.problem.distance_limits().swept(),
            ConstraintKind::Row => self.problem.rows().swept(),
            ConstraintKind::Friction => friction_swept(self.problem),
        }
    }

    /// Visits places `begin..end` of one schedule.
    fn run(&self, kind: ConstraintKind, begin: usize, end: usize, residual: &mut f64) {
        let schedule = self.schedule(kind);
        let (weights, relaxation) = (self.problem.weights(), self.params.relaxation);
        let mut largest = *residual;
        match kind {
            ConstraintKind::Limit => {
                let rows = self.problem.distance_limits().rows;
                for place in begin..end {
                    let i = schedule.row(place);
                    largest = larger(
                        largest,
                        relax_limit::<RESIDUAL>(
                            &rows[i],
                            weights,
                            relaxation,
                            &self.y,
                            &self.limit_multipliers,
                            i,
                        ),
                    );
                }
            }
            ConstraintKind::Row if self.params.equations => self.run_rows::<true>(begin, end, &mut largest),
            ConstraintKind::Row => self.run_rows::<false>(begin, end, &mut largest),
            ConstraintKind::Friction => {
                for place in begin..end {
                    largest = larger(largest, self.relax_friction(schedule.row(place)));
                }
            }
        }
        *residual = largest;
    }

    #[inline(always)]
    fn run_rows<const EQUATION: bool>(&self, begin: usize, end: usize, largest: &mut f64) {
        let schedule = self.schedule(ConstraintKind::Row);
        let (weights, relaxation) = (self.problem.weights(), self.params.relaxation);
        let (rows, attached) = (self.problem.rows().rows, self.problem.attached());
        for place in begin..end {
            let i = schedule.row(place);
            let row = &rows[i];
            *largest = larger(
                *largest,
                relax_row::<RESIDUAL, EQUATION>(row, weights, relaxation, &self.y, &self.lambda, i),
            );
            if let Some(&friction) = attached.get(i)
                && friction != LcpProblem::NO_FRICTION
            {
                *largest = larger(*largest, self.relax_friction(friction as usize));
            }
        }
    }

    #[inline(always)]
    fn relax_friction(&self, index: usize) -> f64 {
        let rule = FrictionRule { relaxation: self.params.relaxation, bound: self.params.friction_bound };
        relax_friction::<RESIDUAL>(
            &self.problem.friction().rows[index],
            self.problem.weights(),
            rule,
            &self.y,
            &self.lambda,
            &self.friction,
            index,
        )
    }
}

/// How many friction rows are swept by their own schedule rather than with their normals.
fn friction_swept(problem: &LcpProblem<'_>) -> usize {
    if problem.attached().is_empty() { problem.friction().swept() } else { 0 }
}

/// Places of one schedule between two points at which all threads wait.
#[derive(Clone, Copy, Debug)]
struct Phase {
    kind: ConstraintKind,
    begin: usize,
    end: usize,
    /// Places that a thread takes at once; all of them if they depend on each other.
    chunk: usize,
}

/// Lists the phases of one sweep. Each color is a phase, but successive colors that one thread takes whole
/// are joined into one. Contacts have many such small colors, and waiting for the other threads costs as much
/// as a dozen rows.
fn list_phases(problem: &LcpProblem<'_>, phases: &mut Vec<Phase>) {
    phases.clear();
    let (limits, rows, friction) = (problem.distance_limits(), problem.rows(), problem.friction());
    let sets = [
        (ConstraintKind::Limit, limits.schedule, limits.swept(), LIMIT_CHUNK),
        (ConstraintKind::Row, rows.schedule, rows.swept(), ROW_CHUNK),
        (ConstraintKind::Friction, friction.schedule, friction_swept(problem), ROW_CHUNK),
    ];
    for (kind, schedule, swept, chunk) in sets.into_iter().filter(|set| set.2 > 0) {
        if schedule.starts.is_empty() {
            phases.push(Phase { kind, begin: 0, end: swept, chunk: swept.max(1) });
            continue;
        }
        let mut joined: Option<Phase> = None;
        for ends in schedule.starts.windows(2) {
            let (begin, end) = (ends[0] as usize, ends[1] as usize);
            if end - begin > chunk {
                phases.extend(joined.take());
                phases.push(Phase { kind, begin, end, chunk });
            } else {
                let begin = joined.map_or(begin, |phase| phase.begin);
                joined = Some(Phase { kind, begin, end, chunk: (end - begin).max(1) });
            }
        }
        phases.extend(joined);
    }
}

impl<Y, L, F, T, const RESIDUAL: bool> Phases for Sweep<'_, Y, L, F, T, RESIDUAL>
where
    Y: Slots<Vector> + Sync,
    L: Slots<f64> + Sync,
    F: Slots<Vector> + Sync,
    T: Slots<TangentVector> + Sync,
{
    fn count(&self) -> usize {
        self.sweeps * self.phases.len()
    }

    fn size(&self, phase: usize) -> (usize, usize) {
        let phase = self.phases[phase % self.phases.len()];
        (phase.end - phase.begin, phase.chunk)
    }

    fn run(&self, phase: usize, places: Range<usize>, residual: &mut f64) {
        let phase = self.phases[phase % self.phases.len()];
        Sweep::run(self, phase.kind, phase.begin + places.start, phase.begin + places.end, residual);
    }
}
