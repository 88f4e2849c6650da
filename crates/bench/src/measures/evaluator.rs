//! Measures the quality of a result.

use super::rows::RowSet;
use crate::case::CollisionCase;
use anyhow::Result;
use bowknot::check::{Judge, StateOptions};
use bowknot::geometry::Point;
use bowknot::proximity::ProximitySearch;
use bowknot::twoway::{CallInput, CollisionScene};
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// The measured quality of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// The objective 1/2 sum m |x - y0|^2 over the free vertices [kg m^2].
    pub objective: f64,
    /// Root mean square of |x - y0| over mass [m].
    pub distance: f64,
    /// Largest violation of a contact row, delta_p less the gap [m]; 0 if none is violated.
    pub violation: f64,
    /// Largest excess of an edge over its limit, as a share of the limit [1]; negative if no edge reaches its
    /// limit.
    pub stretch_violation: f64,
    /// Stationarity residual, root mean square over mass [m]: the motion from x that lessens the objective
    /// and that no active row forbids.
    pub stationarity: f64,
    /// Largest stationarity residual of a vertex [m].
    pub stationarity_max: f64,
    /// Smallest distance of a pair in range [m]; none if none is in range.
    pub min_gap: Option<f64>,
    /// Largest ratio of an edge's length to that at the start.
    pub step_stretch: f64,
    /// Largest ratio of an edge's length to that at rest.
    pub rest_stretch: f64,
    /// Intersecting pairs, by exact predicates.
    pub intersections: usize,
    /// Distance to the reference solution, root mean square over mass [m]; none if there is no reference
    /// solution.
    pub error: Option<f64>,
}

/// Largest number of iterations for multipliers: of results, whose residual may be an upper bound, and of
/// candidates for the reference solution.
const ITERATIONS: [usize; 2] = [400, 6000];

/// Measures the quality of the results of a case.
#[derive(Debug)]
pub struct CaseEvaluator<'a> {
    case: &'a CollisionCase,
    scene: CollisionScene,
    call: CallInput,
    judge: Judge,
    /// Iterations of non-negative least squares.
    iterations: usize,
    search: RefCell<ProximitySearch>,
    reference: Option<Vec<Point>>,
}

impl<'a> CaseEvaluator<'a> {
    /// Without a reference solution: only residuals are measured.
    ///
    /// # Errors
    /// If the case has unsound parameters.
    pub fn of_residuals(case: &'a CollisionCase) -> Result<Self> {
        Self::with_iterations(case, ITERATIONS[0])
    }

    /// Without a reference solution, for a candidate of one: residuals are measured more exactly.
    ///
    /// # Errors
    /// If the case has unsound parameters.
    pub fn of_candidate(case: &'a CollisionCase) -> Result<Self> {
        Self::with_iterations(case, ITERATIONS[1])
    }

    fn with_iterations(case: &'a CollisionCase, iterations: usize) -> Result<Self> {
        let (scene, call) = case.reference()?;
        Ok(Self {
            case,
            scene,
            call,
            judge: Judge::from_model(&case.model),
            iterations,
            search: RefCell::new(ProximitySearch::new(&case.model)),
            reference: None,
        })
    }

    /// The same with a reference solution; none: the case has none.
    #[must_use]
    pub fn and_reference(self, reference: Option<Vec<Point>>) -> Self {
        Self { reference, ..self }
    }

    /// The scene with the parameters that results are measured with.
    pub fn scene(&self) -> &CollisionScene {
        &self.scene
    }

    /// Measures the quality of a result.
    ///
    /// # Errors
    /// If `x` does not fit the case.
    pub fn evaluate(&self, x: &[Point]) -> Result<Quality> {
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
        let error = self.reference.as_ref().map(|reference| {
            mean(weighted(&mut x.iter().zip(reference).map(|(a, b)| (a - b).norm_squared())))
        });
        let options = StateOptions { limit: 0, distance: false };
        Ok(Quality {
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
