//! The exact solution of a small problem: the linearisation iterated to its fixed point.
//!
//! The two-way method with many sweeps and nothing left to travel does that without ever intersecting: its proximal
//! term vanishes at the fixed point, which is a KKT point of the problem with its rows linearised there. That it is one
//! is not taken on trust: the stationarity residual, which shares no code with the backward step, must be small against
//! what the collision stage moves, and violations small against delta; else the case has no exact solution. Problems are
//! not convex, a method may end in another minimum: its error is then large however good it is.

use super::Judgement;
use crate::bench::Bench;
use crate::case::Case;
use anyhow::Result;
use bowknot::geometry::Point;
use bowknot::twoway::{AcceptedState, Params, StopRule};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;

/// Vertices above which no exact solution is sought.
const LARGEST: usize = 6000;
/// Motion of a step at which the iteration is at rest, in mean edge lengths.
const REST: f64 = 1e-7;
/// Largest stationarity residual, as a share of the distance to the target, or in mean edge lengths where that is small.
const RESIDUAL: [f64; 2] = [0.01, 1e-4];
/// Largest violation of a contact, as a share of delta.
const VIOLATION: f64 = 0.05;

/// The exact solution as it is kept.
#[derive(Debug, Serialize, Deserialize)]
struct Found {
    /// Positions [m]; empty if there is none.
    x: Vec<[f64; 3]>,
    stationarity: f64,
    violation: f64,
    steps: usize,
}

/// The solution, found once for each case; none for large cases and where the iteration does not come to rest.
pub fn solution(bench: &Bench, case: &Case) -> Result<Option<Vec<Point>>> {
    if case.states.x.len() > LARGEST {
        return Ok(None);
    }
    let found: Found = bench.store.measured(&format!("exact/{}", case.name), || {
        // A minute at most; hard contact takes longer to come to rest, and has no exact solution then.
        find(case, bench.size.pick(60.0, 4.0, 1.0))
    })?;
    Ok((!found.x.is_empty()).then(|| found.x.into_iter().map(Point::from).collect()))
}

/// `fast` with nothing left to chance.
pub fn params(seconds: f64) -> Params {
    let mut params = Params::fast();
    params.solver.backward.sweeps = 200;
    params.solver.backward.polish_sweeps = 200;
    params.solver.backward.active_rows = false;
    params.solver.stop.max_steps = Some(20_000);
    params.solver.stop.max_seconds = Some(seconds);
    // It ends when x is at rest, by no rule of its own.
    params.solver.stop.rule = StopRule::Travel { net_residual: 0.0, residual: None };
    params
}

/// Stops a solve once a step moves nothing any more.
pub fn at_rest(case: &Case) -> impl FnMut(&AcceptedState<'_>) -> ControlFlow<()> + use<> {
    // Grains have no edges; a micrometre is as little for them.
    let rest = case.mean_edge().map_or(1e-9, |length| REST * length);
    move |state| {
        let moved = state.positions.iter().zip(state.previous).map(|(a, b)| (a - b).norm());
        match moved.fold(0.0, f64::max) < rest {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

fn find(case: &Case, seconds: f64) -> Result<Found> {
    let mut resolver = case.resolver(params(seconds))?;
    let mut x = case.states.x.clone();
    let statistics =
        resolver.resolve_with(&mut x, &case.states.y, &case.states.input(), &mut at_rest(case))?;
    let judgement = Judgement::without_exact(case)?;
    let judged = judgement.judge(&x)?;
    let lengths = judgement.scene.lengths();
    let good = judged.stationarity <= (RESIDUAL[0] * judged.distance).max(RESIDUAL[1] * lengths.edge)
        && judged.violation <= VIOLATION * lengths.delta
        && judged.intersections == 0;
    let x = if good { x.iter().map(|p| [p.x, p.y, p.z]).collect() } else { Vec::new() };
    Ok(Found { x, stationarity: judged.stationarity, violation: judged.violation, steps: statistics.steps })
}
