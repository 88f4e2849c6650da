//! Projected Gauss-Seidel: one row after the other, or colour by colour with the rows of a colour in
//! parallel.
//!
//! Both visit the rows in the order of the schedule and compute each alike, so they give the same
//! bits, whatever the number of threads: rows of a colour share no node that moves.

use crate::kernels::{relax_ball, relax_friction, relax_row};
use crate::params::{Info, Params};
use crate::problem::{Problem, Schedule, State};
use crate::slots::{Slots, atomics, cells};
use crate::team::{self, Phases};
use crate::{Error, Vector};
use nalgebra::Vector2;
use std::ops::Range;

/// Rows a thread takes at once: enough to drown the counter's cost (50 ns), few enough that
/// a colour of some hundred is shared evenly.
const ROW_CHUNK: usize = 64;
/// Ball rows are cheaper than rows.
const BALL_CHUNK: usize = 128;
/// Below this many rows of all kinds a sweep takes less time than waking a thread.
const PARALLEL_MIN: usize = 1024;

/// One sweep in the order of the schedules, on this thread.
///
/// # Errors
/// [`Error::Length`] if the state does not fit the problem; [`Error::Parameter`].
pub fn sweep_serial(problem: &Problem<'_>, state: &mut State<'_>, params: &Params) -> Result<(), Error> {
    params.validate()?;
    state.check(problem)?;
    serial::<false>(problem, state, params, 1);
    Ok(())
}

/// Sweeps in the order of the schedules, on this thread.
///
/// # Errors
/// [`Error::Length`] if the state does not fit the problem; [`Error::Parameter`]; [`Error::NotConverged`] if
/// [`Params::tolerance`] asks for more than `max_sweeps` give.
pub fn solve_serial(problem: &Problem<'_>, state: &mut State<'_>, params: &Params) -> Result<Info, Error> {
    params.validate()?;
    state.check(problem)?;
    repeat(params, |residual, sweeps| match residual {
        true => serial::<true>(problem, state, params, sweeps),
        false => serial::<false>(problem, state, params, sweeps),
    })
}

/// One sweep, the rows of a colour in parallel on the threads of the current rayon pool. The same
/// bits as [`sweep_serial`] if the colours are valid ([`crate::validate_colours`]).
///
/// # Errors
/// [`Error::Length`] if the state does not fit the problem; [`Error::Parameter`].
pub fn sweep_coloured(problem: &Problem<'_>, state: &mut State<'_>, params: &Params) -> Result<(), Error> {
    params.validate()?;
    state.check(problem)?;
    coloured::<false>(problem, state, params, 1);
    Ok(())
}

/// Sweeps, the rows of a colour in parallel on the threads of the current rayon pool. The same bits as
/// [`solve_serial`] if the colours are valid ([`crate::validate_colours`]).
///
/// # Errors
/// As [`solve_serial`].
pub fn solve_coloured(problem: &Problem<'_>, state: &mut State<'_>, params: &Params) -> Result<Info, Error> {
    params.validate()?;
    state.check(problem)?;
    repeat(params, |residual, sweeps| match residual {
        true => coloured::<true>(problem, state, params, sweeps),
        false => coloured::<false>(problem, state, params, sweeps),
    })
}

/// Runs sweeps with as few calls, and asking for as few residuals, as the tolerance allows.
fn repeat(params: &Params, mut sweep: impl FnMut(bool, u32) -> f64) -> Result<Info, Error> {
    let sweeps = params.max_sweeps;
    let Some(tolerance) = params.tolerance else {
        sweep(false, sweeps.saturating_sub(1));
        return Ok(Info { sweeps, residual: sweep(true, sweeps.min(1)) });
    };
    let mut residual = f64::INFINITY;
    for sweeps in 1..=sweeps {
        residual = sweep(true, 1);
        if residual <= tolerance {
            return Ok(Info { sweeps, residual });
        }
    }
    Err(Error::NotConverged { sweeps, residual })
}

fn serial<const RESIDUAL: bool>(
    problem: &Problem<'_>,
    state: &mut State<'_>,
    params: &Params,
    sweeps: u32,
) -> f64 {
    let sweep = Sweep::<_, _, _, _, RESIDUAL> {
        problem,
        params,
        phases: Vec::new(),
        sweeps: sweeps as usize,
        y: cells(state.y),
        lambda: cells(state.lambda),
        forces: cells(state.forces),
        friction: cells(state.friction),
    };
    let mut residual = 0.0;
    for _ in 0..sweeps {
        for kind in [Kind::Ball, Kind::Row, Kind::Friction] {
            sweep.run(kind, 0, sweep.swept(kind), &mut residual);
        }
    }
    residual
}

fn coloured<const RESIDUAL: bool>(
    problem: &Problem<'_>,
    state: &mut State<'_>,
    params: &Params,
    sweeps: u32,
) -> f64 {
    let rows = problem.balls().swept() + problem.rows().swept() + problem.friction().swept();
    let threads = rayon::current_num_threads();
    if threads == 1 || rows < PARALLEL_MIN || sweeps == 0 {
        return serial::<RESIDUAL>(problem, state, params, sweeps);
    }
    let views = (atomics(state.y), atomics(state.lambda), atomics(state.forces), atomics(state.friction));
    let (Some(y), Some(lambda), Some(forces), Some(friction)) = views else {
        return serial::<RESIDUAL>(problem, state, params, sweeps);
    };
    let sweep = Sweep::<_, _, _, _, RESIDUAL> {
        problem,
        params,
        phases: phases(problem),
        sweeps: sweeps as usize,
        y,
        lambda,
        forces,
        friction,
    };
    team::run(&sweep, threads)
}

/// The larger of two numbers in one instruction; `f64::max` takes five, in a chain through all rows.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The families in the order of a sweep.
#[derive(Clone, Copy)]
enum Kind {
    Ball,
    Row,
    Friction,
}

/// Sweeps over views of the state.
struct Sweep<'a, Y, L, F, T, const RESIDUAL: bool> {
    problem: &'a Problem<'a>,
    params: &'a Params,
    /// The phases of one sweep, where threads share it.
    phases: Vec<Phase>,
    sweeps: usize,
    y: Y,
    lambda: L,
    forces: F,
    friction: T,
}

impl<Y, L, F, T, const RESIDUAL: bool> Sweep<'_, Y, L, F, T, RESIDUAL>
where
    Y: Slots<Vector>,
    L: Slots<f64>,
    F: Slots<Vector>,
    T: Slots<Vector2<f64>>,
{
    fn schedule(&self, kind: Kind) -> Schedule<'_> {
        match kind {
            Kind::Ball => self.problem.balls().schedule,
            Kind::Row => self.problem.rows().schedule,
            Kind::Friction => self.problem.friction().schedule,
        }
    }

    fn swept(&self, kind: Kind) -> usize {
        match kind {
            Kind::Ball => self.problem.balls().swept(),
            Kind::Row => self.problem.rows().swept(),
            Kind::Friction => friction_swept(self.problem),
        }
    }

    /// Visits places `begin..end` of a family's schedule.
    fn run(&self, kind: Kind, begin: usize, end: usize, residual: &mut f64) {
        let schedule = self.schedule(kind);
        let (weights, relaxation) = (self.problem.weights(), self.params.relaxation);
        let mut largest = *residual;
        match kind {
            Kind::Ball => {
                let rows = self.problem.balls().rows;
                for place in begin..end {
                    let i = schedule.row(place);
                    largest = larger(
                        largest,
                        relax_ball::<RESIDUAL>(&rows[i], weights, relaxation, &self.y, &self.forces, i),
                    );
                }
            }
            Kind::Row if self.params.equations => self.run_rows::<true>(begin, end, &mut largest),
            Kind::Row => self.run_rows::<false>(begin, end, &mut largest),
            Kind::Friction => {
                for place in begin..end {
                    largest = larger(largest, self.relax_friction(schedule.row(place)));
                }
            }
        }
        *residual = largest;
    }

    #[inline(always)]
    fn run_rows<const EQUATION: bool>(&self, begin: usize, end: usize, largest: &mut f64) {
        let schedule = self.schedule(Kind::Row);
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
                && friction != Problem::NO_FRICTION
            {
                *largest = larger(*largest, self.relax_friction(friction as usize));
            }
        }
    }

    #[inline(always)]
    fn relax_friction(&self, index: usize) -> f64 {
        relax_friction::<RESIDUAL>(
            &self.problem.friction().rows[index],
            self.problem.weights(),
            self.params.relaxation,
            self.params.friction_bound,
            &self.y,
            &self.lambda,
            &self.friction,
            index,
        )
    }
}

/// Friction rows that have a turn of their own, rather than one with their normals.
fn friction_swept(problem: &Problem<'_>) -> usize {
    if problem.attached().is_empty() { problem.friction().swept() } else { 0 }
}

/// Places of one family's schedule between two waits of all threads.
#[derive(Clone, Copy)]
struct Phase {
    kind: Kind,
    begin: usize,
    end: usize,
    /// Places that a thread takes at once; all of them where they depend on each other.
    chunk: usize,
}

/// The phases of one sweep: a colour each, but colours so small that one thread takes them whole are joined with
/// their like. Contacts have a long tail of such colours, and waiting for the others costs as much as a dozen rows.
fn phases(problem: &Problem<'_>) -> Vec<Phase> {
    let mut phases = Vec::new();
    let families = [
        (Kind::Ball, problem.balls().schedule, problem.balls().swept(), BALL_CHUNK),
        (Kind::Row, problem.rows().schedule, problem.rows().swept(), ROW_CHUNK),
        (Kind::Friction, problem.friction().schedule, friction_swept(problem), ROW_CHUNK),
    ];
    for (kind, schedule, swept, chunk) in families.into_iter().filter(|family| family.2 > 0) {
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
    phases
}

impl<Y, L, F, T, const RESIDUAL: bool> Phases for Sweep<'_, Y, L, F, T, RESIDUAL>
where
    Y: Slots<Vector> + Sync,
    L: Slots<f64> + Sync,
    F: Slots<Vector> + Sync,
    T: Slots<Vector2<f64>> + Sync,
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
