//! Impact-zone optimisation alone, from the target only.

use super::rows::ImpactRows;
use super::{Impact, ImpactSearch};
use crate::{Method, Outcome};
use bowknot_twoway::geometry::{Point, Vector};
use bowknot_twoway::{CallInput, CollisionScene, ResolveError, ResolveInput};
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Settings of [`ImpactZones`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ZoneParams {
    /// Rounds of detection and optimisation before it gives up. Default 100.
    pub max_iterations: usize,
    /// What solves the zones. Default Gauss-Seidel.
    pub solver: ZoneSolver,
    /// Sweeps, or gradient steps, of one optimisation at most. Default 200.
    pub max_sweeps: u32,
    /// Gauss-Seidel stops when a sweep changes no row by more, in desired distances. Default 0.01.
    pub tolerance: f64,
    /// Share of its desired distance below which a pair that does not meet, but ends there, gets a row too. Default 0, as
    /// published: zones forbid to meet, not to be near. With 0.8 they solve the problem of the methods that keep a
    /// distance, to a fifth of it; nearer to 1 rows that are linearised in turns may chase each other.
    pub thickness: f64,
}

/// What solves the rows of impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ZoneSolver {
    /// Projected Gauss-Seidel: the kindest of the three.
    GaussSeidel,
    /// Gauss-Seidel on equations, as Harmon et al. 2008 have them: what has met once sticks for the rest of the call.
    LinearSystem,
    /// The augmented Lagrangian of Tang et al. 2018.
    AugmentedLagrangian,
}

impl Default for ZoneParams {
    fn default() -> Self {
        Self {
            max_iterations: 100,
            solver: ZoneSolver::GaussSeidel,
            max_sweeps: 200,
            tolerance: 0.01,
            thickness: 0.0,
        }
    }
}

/// Impact-zone optimisation alone (Harmon et al. 2008; Tang et al. 2018): the target y nearest to y0 with
/// n . (p - q)(y) >= delta for every pair that has met so far, rows linearised at the impact; then detection from x to y
/// again, until nothing meets. A pair that meets again gets its row anew. Zones are the sets of vertices that rows join; no row
/// joins two of them, so that solving all at once solves each.
///
/// It ends at a y that the straight path from x reaches without an impact, or fails: [`Outcome::failed`], positions as
/// they were. Vertices that are prescribed go to their keyframe or make it fail; edges have no limits.
#[derive(Debug)]
pub struct ImpactZones {
    scene: CollisionScene,
    /// Settings.
    pub params: ZoneParams,
    search: ImpactSearch,
    rows: ImpactRows,
}

/// The target as far as it was optimised.
#[derive(Debug)]
pub(crate) struct Attempt {
    /// y [m].
    pub(crate) target: Vec<Point>,
    /// Whether the straight path to it is free of impacts.
    pub(crate) clear: bool,
}

impl ImpactZones {
    /// Of the scene in `problem`; of its parameters lengths and limits on steps and seconds count.
    pub fn new(scene: CollisionScene, params: ZoneParams) -> Self {
        let search = ImpactSearch::new(scene.model());
        Self { scene, params, search, rows: ImpactRows::default() }
    }

    /// Optimises the target; leaves positions alone.
    pub(crate) fn optimise(
        &mut self,
        positions: &[Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        outcome: &mut Outcome,
    ) -> Result<Attempt, ResolveError> {
        let clock = Instant::now();
        let Self { scene, params, search, rows } = self;
        let call = CallInput::new(scene, positions, target, input)?;
        let growth = growth(scene, &call);
        let limits = &scene.params().solver.stop;
        let max_iterations = limits.max_steps.unwrap_or(usize::MAX).min(params.max_iterations);
        let free: Vec<Vector> = target.iter().map(|y| y.coords).collect();
        let mut y = free.clone();
        let mut paths = Vec::with_capacity(y.len());
        rows.clear();
        search.thickness = params.thickness;
        loop {
            paths.clear();
            paths.extend(y.iter().zip(positions).map(|(y, x)| y - x.coords));
            let impacts: Vec<Impact> = search.find(scene, positions, &paths, growth, |_| true, outcome);
            let out_of_time = limits.max_seconds.is_some_and(|s| clock.elapsed().as_secs_f64() > s);
            if impacts.is_empty() || outcome.steps >= max_iterations || out_of_time {
                let target = y.into_iter().map(Point::from).collect();
                return Ok(Attempt { target, clear: impacts.is_empty() });
            }
            let backward = Instant::now();
            impacts.iter().for_each(|impact| rows.add(scene, impact, positions, &paths));
            if let Err(error) = rows.solve(scene, &call, params, &free, &mut y) {
                // Built from checked parts: a refusal is our own error.
                tracing::error!(%error, "impact zones refused their own rows");
                let target = y.into_iter().map(Point::from).collect();
                return Ok(Attempt { target, clear: false });
            }
            outcome.steps += 1;
            outcome.seconds.backward += backward.elapsed().as_secs_f64();
        }
    }
}

/// By how much, at most, a call asks a gap to grow [m].
pub(crate) fn growth(scene: &CollisionScene, call: &CallInput) -> f64 {
    call.time_step().map_or(f64::INFINITY, |dt| scene.lengths().separation_speed * dt)
}

impl Method for ImpactZones {
    fn name(&self) -> &str {
        match self.params.solver {
            ZoneSolver::GaussSeidel => "impact zones",
            ZoneSolver::LinearSystem => "impact zones, linear system",
            ZoneSolver::AugmentedLagrangian => "impact zones, augmented Lagrangian",
        }
    }

    fn solve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<Outcome, ResolveError> {
        let clock = Instant::now();
        let mut outcome = Outcome::default();
        let attempt = self.optimise(positions, target, input, &mut outcome)?;
        outcome.converged = attempt.clear;
        outcome.failed = !attempt.clear;
        if attempt.clear {
            positions.copy_from_slice(&attempt.target);
        }
        outcome.seconds.total = clock.elapsed().as_secs_f64();
        Ok(outcome)
    }
}
