//! Impact-zone optimization of the target alone.

use super::impacts::{Impact, ImpactSearch};
use super::params::{ZoneParams, ZoneSolver};
use super::rows::ImpactRows;
use crate::{Method, Outcome};
use bowknot_errors::{Errors, ParamError, Parameters};
use bowknot_twoway::geometry::{Point, Vector};
use bowknot_twoway::{CallInput, CollisionScene, ResolveError, ResolveInput};
use std::time::Instant;

/// Impact-zone optimization alone (Harmon et al. 2008; Tang et al. 2018). Each round finds the target y
/// nearest to y0 with n . (p - q)(y) >= delta for every pair that has met so far, with rows linearized at the
/// impact; then impacts from x to y are detected again, until there are none. A pair that meets again gets a
/// new row. Zones are the sets of vertices that rows connect. No row connects two zones, so that solving all
/// rows at once solves each zone.
///
/// It ends with a y that the straight path from x reaches without an impact. Otherwise the positions stay as
/// they are: the call has failed ([`Outcome::failed`]) if its rounds are used up, and is only not at its end
/// if its time is. Prescribed vertices reach their keyframe, or nothing moves. Edges have no limits.
#[derive(Debug)]
pub struct ImpactZones {
    scene: CollisionScene,
    /// Parameters.
    pub params: ZoneParams,
    search: ImpactSearch,
    rows: ImpactRows,
}

/// The optimized target.
#[derive(Debug)]
pub(crate) struct Attempt {
    /// y [m].
    pub(crate) target: Vec<Point>,
    /// Whether the straight path to it is free of impacts.
    pub(crate) clear: bool,
    /// Whether the time of the call ended before the rounds did.
    pub(crate) out_of_time: bool,
}

impl ImpactZones {
    /// For `scene`. Of its parameters, lengths and limits on steps and seconds matter.
    ///
    /// # Errors
    /// Parameters out of their range.
    pub fn new(scene: CollisionScene, params: ZoneParams) -> Result<Self, Errors<ParamError>> {
        params.validate()?;
        let search = ImpactSearch::new(scene.model());
        Ok(Self { scene, params, search, rows: ImpactRows::default() })
    }

    /// Optimizes the target; positions stay unchanged.
    pub(crate) fn optimize(
        &mut self,
        positions: &[Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        outcome: &mut Outcome,
    ) -> Result<Attempt, ResolveError> {
        let timer = Instant::now();
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
            let is_last = outcome.steps >= max_iterations;
            let out_of_time =
                !is_last && limits.max_seconds.is_some_and(|s| timer.elapsed().as_secs_f64() > s);
            if impacts.is_empty() || is_last || out_of_time {
                let target = y.into_iter().map(Point::from).collect();
                return Ok(Attempt { target, clear: impacts.is_empty(), out_of_time });
            }
            let backward = Instant::now();
            impacts.iter().for_each(|impact| rows.add(scene, impact, positions, &paths, params.goal));
            if let Err(error) = rows.solve(scene, &call, params, &free, &mut y) {
                // The rows are sound by construction: a refusal is a bug.
                tracing::error!(%error, "impact zones refused their own rows");
                let target = y.into_iter().map(Point::from).collect();
                return Ok(Attempt { target, clear: false, out_of_time: false });
            }
            outcome.steps += 1;
            outcome.seconds.backward += backward.elapsed().as_secs_f64();
        }
    }
}

/// Largest growth of a gap that a call may ask for [m].
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
        let timer = Instant::now();
        let mut outcome = Outcome::default();
        let attempt = self.optimize(positions, target, input, &mut outcome)?;
        outcome.converged = attempt.clear;
        outcome.failed = !attempt.clear && !attempt.out_of_time;
        if attempt.clear {
            positions.copy_from_slice(&attempt.target);
        }
        outcome.seconds.total = timer.elapsed().as_secs_f64();
        Ok(outcome)
    }
}
