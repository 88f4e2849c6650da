//! The reference solution of a small problem: `fast` iterated to a fixed point of the linearization.
//!
//! With 200 sweeps and rows for all pairs, `fast` runs until a step moves nothing any more, without ever
//! intersecting. Its proximal term vanishes at such a fixed point, which is then a KKT point of the problem
//! with its rows linearized there. So the reference comes from the method that is compared, not from
//! independent code. Two checks guard it, otherwise the case has no reference: violations are small against
//! delta, and the stationarity residual, whose multipliers come from a solver of their own (`nonnegative`),
//! is small against the distance to the target.
//!
//! The problems are not convex. A method may end in another minimum; its error is then large however good
//! that minimum is.

use super::evaluator::CaseEvaluator;
use crate::bench::Bench;
use crate::case::CollisionCase;
use anyhow::Result;
use bowknot::geometry::Point;
use bowknot::twoway::{AcceptedState, Params, StopRule};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Largest number of vertices of a case with a reference solution.
const MAX_VERTICES: usize = 6000;
/// Largest motion of a vertex in a step that counts as at rest, in mean edge lengths.
const REST: f64 = 1e-7;
/// Largest stationarity residual, as a share of the distance to the target, or in mean edge lengths,
/// whichever allows more.
const RESIDUAL: [f64; 2] = [0.01, 1e-4];
/// Largest violation of a contact, as a share of delta.
const VIOLATION: f64 = 0.05;

/// The reference solution as it is stored.
#[derive(Debug, Serialize, Deserialize)]
struct Found {
    /// Positions [m]; empty if there is none.
    x: Vec<[f64; 3]>,
    stationarity: f64,
    violation: f64,
    steps: usize,
}

/// Measures the quality of results with the reference solution, if the case has one.
///
/// # Errors
/// If the case has unsound parameters or cannot be solved.
pub fn with_reference<'a>(bench: &Bench, case: &'a CollisionCase) -> Result<CaseEvaluator<'a>> {
    Ok(CaseEvaluator::of_residuals(case)?.and_reference(solution(bench, case)?))
}

/// The solution, found once for each case; none for large cases, and if the iteration does not come to rest.
fn solution(bench: &Bench, case: &CollisionCase) -> Result<Option<Vec<Point>>> {
    if case.states.x.len() > MAX_VERTICES {
        return Ok(None);
    }
    let found: Found = bench.store.measured(&format!("reference/{}", case.name), || {
        // A minute at most. Hard contact takes longer to come to rest; such cases have no reference.
        find(case, bench.size.pick(60.0, 4.0, 1.0))
    })?;
    Ok((!found.x.is_empty()).then(|| found.x.into_iter().map(Point::from).collect()))
}

/// Parameters of the reference: `fast` with many sweeps and without its shortcuts.
pub fn params(seconds: f64) -> Params {
    let mut params = Params::fast();
    params.solver.backward.sweeps = 200;
    params.solver.backward.polish_sweeps = 200;
    params.solver.backward.active_rows = false;
    params.solver.stop.max_steps = Some(20_000);
    params.solver.stop.max_seconds = Some(seconds);
    // `at_rest` ends the solve; the stopping rule never does.
    params.solver.stop.rule = StopRule::Travel { net_residual: 0.0, residual: None };
    params
}

/// An observer that stops a solve once no vertex moves any more.
pub fn at_rest(case: &CollisionCase) -> impl FnMut(&AcceptedState<'_>) -> ControlFlow<()> + use<> {
    // Sand has no edges: a nanometer.
    let rest = case.mean_edge().map_or(1e-9, |length| REST * length);
    move |state| {
        let moved = state.positions.iter().zip(state.previous).map(|(a, b)| (a - b).norm());
        if moved.fold(0.0, f64::max) < rest { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn find(case: &CollisionCase, seconds: f64) -> Result<Found> {
    let mut resolver = case.resolver(params(seconds))?;
    let mut x = case.states.x.clone();
    let statistics =
        resolver.resolve_with(&mut x, &case.states.y, &case.states.input(), &mut at_rest(case))?;
    let evaluator = CaseEvaluator::of_candidate(case)?;
    let quality = evaluator.evaluate(&x)?;
    let lengths = evaluator.scene().lengths();
    let good = quality.stationarity <= (RESIDUAL[0] * quality.distance).max(RESIDUAL[1] * lengths.edge)
        && quality.violation <= VIOLATION * lengths.delta
        && quality.intersections == 0;
    let x = if good { x.iter().map(|p| [p.x, p.y, p.z]).collect() } else { Vec::new() };
    Ok(Found { x, stationarity: quality.stationarity, violation: quality.violation, steps: statistics.steps })
}
