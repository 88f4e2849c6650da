//! The reference solution of a small problem, by a solver (`augmented`) that shares with the methods only the lengths
//! that define the problem.
//!
//! It is found from the start of the problem by three ways: straight to the target, and by way of targets in between,
//! few and many; the last is left out if the others end badly. Each is a path that crosses nothing. Of those that end well the one with the least objective is the
//! reference. A result ends well if its violations are small against delta, and its stationarity residual, whose
//! multipliers come from another solver (`nonnegative`), is small against the distance to the target.
//!
//! The problems are not convex. A method may end in another minimum; its error is then large however good
//! that minimum is, and its objective tells.

use super::augmented::project;
use super::evaluator::CaseEvaluator;
use crate::bench::Bench;
use crate::case::CollisionCase;
use crate::store::REFERENCE;
use anyhow::Result;
use bowknot::geometry::Point;
use serde::{Deserialize, Serialize};

/// Largest number of vertices of a case with a reference solution.
const MAX_VERTICES: usize = 6000;
/// Largest stationarity residual, as a share of the distance to the target, or in mean edge lengths,
/// whichever allows more.
const RESIDUAL: [f64; 2] = [0.01, 1e-4];
/// Largest violation of a contact, as a share of delta.
const VIOLATION: f64 = 0.05;
/// Shares of the way to the target of the targets in between.
const WAYS: [&[f64]; 3] = [&[1.0], &[0.5, 1.0], &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]];

/// The reference solution as it is stored.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Found {
    /// Positions [m]; empty if there is none.
    x: Vec<[f64; 3]>,
    objective: f64,
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

/// The solution, found once for each case; none for large cases, and if no way ends well.
fn solution(bench: &Bench, case: &CollisionCase) -> Result<Option<Vec<Point>>> {
    if case.states.x.len() > MAX_VERTICES {
        return Ok(None);
    }
    let mut best: Option<Found> = None;
    let ways = bench.size.pick(&WAYS[..], &WAYS[..1], &WAYS[..1]);
    for (number, shares) in ways.iter().enumerate() {
        // A minute and a half are saved where two have failed.
        if number == 2 && best.is_none() {
            break;
        }
        let found: Found = bench.store.measured(&format!("{REFERENCE}{}/{number}", case.name), || {
            find(case, shares, bench.size.pick(90.0, 4.0, 1.0))
        })?;
        if !found.x.is_empty() && best.as_ref().is_none_or(|best| found.objective < best.objective) {
            best = Some(found);
        }
    }
    Ok(best.map(|found| found.x.into_iter().map(Point::from).collect()))
}

fn find(case: &CollisionCase, shares: &[f64], seconds: f64) -> Result<Found> {
    let evaluator = CaseEvaluator::of_candidate(case)?;
    let projected = project(&evaluator.statement, shares, seconds)?;
    let quality = evaluator.evaluate(&projected.x)?;
    let lengths = evaluator.statement.scene.lengths();
    let good = quality.stationarity <= (RESIDUAL[0] * quality.distance).max(RESIDUAL[1] * lengths.edge)
        && quality.violation <= VIOLATION * lengths.delta
        && quality.stretch_violation <= 1e-3
        && quality.intersections == 0;
    let x = if good { projected.x.iter().map(|p| [p.x, p.y, p.z]).collect() } else { Vec::new() };
    let (objective, stationarity, violation) = (quality.objective, quality.stationarity, quality.violation);
    Ok(Found { x, objective, stationarity, violation, steps: projected.steps })
}
