//! How good a result x of a collision problem is, alike for every method.
//!
//! All is judged by one row set: contacts within range and edge limits, linearised at x ([`rows`]), under one set of
//! parameters ([`crate::case::Case::reference`]), whatever the method's own.

mod exact;
mod nonnegative;
mod rows;

use crate::bench::Bench;
use crate::case::Case;
use anyhow::Result;
use bowknot::check::{Judge, StateOptions};
use bowknot::geometry::Point;
use bowknot::proximity::ProximitySearch;
use bowknot::twoway::{CallInput, CollisionScene};
use rows::RowSet;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// What is measured of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The objective 1/2 sum m |x - y0|^2 over the free vertices [kg m^2].
    pub objective: f64,
    /// Root mean square of |x - y0| over mass [m].
    pub distance: f64,
    /// Largest violation of a contact row, delta_p less the gap [m]; 0 if none is violated.
    pub violation: f64,
    /// Largest share by which an edge exceeds its limit [1].
    pub stretch_violation: f64,
    /// Stationarity residual, root mean square over mass [m]: the motion from x that would still lessen the objective,
    /// all active rows obeyed.
    pub stationarity: f64,
    /// Largest of it at a vertex [m].
    pub stationarity_max: f64,
    /// Smallest distance of a pair in range [m]; none if none is in range.
    pub min_gap: Option<f64>,
    /// Largest ratio of an edge's length to that at the start.
    pub step_stretch: f64,
    /// Largest ratio of an edge's length to that at rest.
    pub rest_stretch: f64,
    /// Intersecting pairs, by exact predicates.
    pub intersections: usize,
    /// Root mean square over mass of the distance to the exact solution [m], where there is one.
    pub error: Option<f64>,
}

/// Iterations that multipliers are found in: of results, whose residual may be an upper bound, and of what is to be the
/// exact solution.
const ITERATIONS: [usize; 2] = [400, 6000];

/// A case with what judging its results needs.
#[derive(Debug)]
pub struct Judgement<'a> {
    case: &'a Case,
    scene: CollisionScene,
    call: CallInput,
    judge: Judge,
    /// Iterations of non-negative least squares.
    iterations: usize,
    search: RefCell<ProximitySearch>,
    exact: Option<Vec<Point>>,
}

impl<'a> Judgement<'a> {
    /// Finds the exact solution too, where the case is small enough for it and there is time.
    pub fn new(bench: &Bench, case: &'a Case) -> Result<Self> {
        Ok(Self { exact: exact::solution(bench, case)?, ..Self::of_residuals(case)? })
    }

    /// Without an exact solution: results have residuals alone.
    pub fn of_residuals(case: &'a Case) -> Result<Self> {
        Ok(Self { iterations: ITERATIONS[0], ..Self::without_exact(case)? })
    }

    fn without_exact(case: &'a Case) -> Result<Self> {
        let (scene, call) = case.reference()?;
        Ok(Self {
            case,
            scene,
            call,
            judge: Judge::from_model(&case.model),
            iterations: ITERATIONS[1],
            search: RefCell::new(ProximitySearch::new(&case.model)),
            exact: None,
        })
    }

    /// Judges a result.
    pub fn judge(&self, x: &[Point]) -> Result<Judged> {
        let (scene, call, states) = (&self.scene, &self.call, &self.case.states);
        let rows = RowSet::new(scene, call, states, x, &mut self.search.borrow_mut());
        let residual = rows.stationarity(scene, call, x, &states.y, self.iterations);
        let distances = x.iter().zip(&states.y).map(|(x, y)| x - y);
        let total: f64 = (0..x.len()).filter(|&v| call.is_movable(v)).map(|v| scene.relative_mass(v)).sum();
        let weighted = |vectors: &mut dyn Iterator<Item = f64>| -> f64 {
            let squares = vectors.enumerate().filter(|(v, _)| call.is_movable(*v));
            squares.map(|(v, square)| scene.relative_mass(v) * square).sum()
        };
        let mean = |sum: f64| (sum / total.max(f64::MIN_POSITIVE)).sqrt();
        let square = weighted(&mut distances.map(|d| d.norm_squared()));
        let error = self
            .exact
            .as_ref()
            .map(|exact| mean(weighted(&mut x.iter().zip(exact).map(|(a, b)| (a - b).norm_squared()))));
        let options = StateOptions { limit: 0, distance: false };
        Ok(Judged {
            objective: 0.5 * scene.mean_mass() * square,
            distance: mean(square),
            violation: rows.contact_violation(),
            stretch_violation: rows.stretch.to_limit - 1.0,
            stationarity: mean(weighted(&mut residual.iter().map(|r| r.norm_squared()))),
            stationarity_max: residual.iter().map(|r| r.norm()).fold(0.0, f64::max),
            min_gap: rows.min_gap,
            step_stretch: rows.stretch.to_start,
            rest_stretch: rows.stretch.to_rest,
            intersections: self.judge.check_state(x, &options)?.intersection_count,
            error,
        })
    }
}

#[cfg(test)]
mod tests;
