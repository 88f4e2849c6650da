//! Measures the quality of a result.

use super::nonnegative::{self, Row};
use super::statement::{About, Constraint, Statement};
use crate::case::CollisionCase;
use anyhow::Result;
use bowknot::check::StateOptions;
use bowknot::geometry::{Point, Vector};
use serde::{Deserialize, Serialize};

/// The measured quality of a result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// The objective 1/2 sum m |x - y0|^2 over the free vertices [kg m^2].
    pub objective: f64,
    /// Root mean square of |x - y0| over mass [m].
    pub distance: f64,
    /// Largest violation of a contact, its contact distance less its gap [m]; 0 if none is violated.
    pub violation: f64,
    /// Largest excess of an edge over its limit, as a share of the limit [1]; negative if no edge reaches its
    /// limit.
    pub stretch_violation: f64,
    /// Stationarity residual, root mean square over mass [m]: the motion from x that lessens the objective
    /// and that no active constraint forbids.
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

/// Slack below which a constraint counts as active: of contacts in contact distances, of edges in limits. Methods
/// stop that far from their active rows.
const ACTIVE: [f64; 2] = [0.1, 0.02];

/// Measures the quality of the results of a case.
#[derive(Debug)]
pub struct CaseEvaluator<'a> {
    pub statement: Statement<'a>,
    /// Iterations of non-negative least squares.
    iterations: usize,
    reference: Option<Vec<Point>>,
}

impl<'a> CaseEvaluator<'a> {
    /// Without a reference solution: only residuals are measured.
    ///
    /// # Errors
    /// If the case has unsound parameters.
    pub fn of_residuals(case: &'a CollisionCase) -> Result<Self> {
        Ok(Self { statement: Statement::new(case)?, iterations: ITERATIONS[0], reference: None })
    }

    /// Without a reference solution, for a candidate of one: residuals are measured more exactly.
    ///
    /// # Errors
    /// If the case has unsound parameters.
    pub fn of_candidate(case: &'a CollisionCase) -> Result<Self> {
        Ok(Self { iterations: ITERATIONS[1], ..Self::of_residuals(case)? })
    }

    /// The same with a reference solution; none: the case has none.
    #[must_use]
    pub fn and_reference(self, reference: Option<Vec<Point>>) -> Self {
        Self { reference, ..self }
    }

    /// Measures the quality of a result.
    ///
    /// # Errors
    /// If `x` does not fit the case.
    pub fn evaluate(&self, x: &[Point]) -> Result<Quality> {
        let statement = &self.statement;
        let target = &statement.case.states.y;
        let constraints = statement.constraints(x, statement.range())?;
        let pairs = || constraints.iter().filter(|c| matches!(c.about, About::Pair(..)));
        let [to_limit, to_start, to_rest] = statement.stretch(x);
        let residual = self.stationarity(x, &constraints);
        let square = self.mean(x.iter().zip(target).map(|(x, y)| x - y));
        let error = self.reference.as_ref().map(|r| self.mean(x.iter().zip(r).map(|(a, b)| a - b)).sqrt());
        let mass: f64 = statement.masses.iter().sum();
        let options = StateOptions { limit: 0, distance: false };
        Ok(Quality {
            objective: 0.5 * statement.scene.mean_mass() * mass * square,
            distance: square.sqrt(),
            violation: pairs().map(|c| -c.value).fold(0.0, f64::max),
            stretch_violation: to_limit - 1.0,
            stationarity: self.mean(residual.iter().copied()).sqrt(),
            stationarity_max: residual.iter().map(Vector::norm).fold(0.0, f64::max),
            min_gap: pairs().map(|c| c.value + c.length).min_by(f64::total_cmp),
            step_stretch: to_start,
            rest_stretch: to_rest,
            intersections: statement.judge.check_state(x, &options)?.intersection_count,
            error,
        })
    }

    /// The mean of squares of the movable vertices' vectors over mass.
    fn mean(&self, vectors: impl Iterator<Item = Vector>) -> f64 {
        let masses = &self.statement.masses;
        let sum: f64 = vectors.zip(masses).map(|(vector, mass)| mass * vector.norm_squared()).sum();
        sum / masses.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// The projection of y0 - x onto the motions that no active constraint forbids, in the metric of mass: 0 if x
    /// solves the problem. By Moreau's decomposition it is y0 - x + M^-1 J^T lambda with the non-negative
    /// multipliers that minimize it. If the iterations do not suffice, the result is an upper bound.
    fn stationarity(&self, x: &[Point], constraints: &[Constraint]) -> Vec<Vector> {
        let Statement { masses, case, .. } = &self.statement;
        let weights: Vec<f64> =
            masses.iter().map(|&mass| if mass > 0.0 { 1.0 / mass } else { 0.0 }).collect();
        let way = |v: usize| {
            if self.statement.is_movable(v) { case.states.y[v] - x[v] } else { Vector::zeros() }
        };
        let active = |constraint: &&Constraint| {
            let share = if matches!(constraint.about, About::Edge(_)) { ACTIVE[1] } else { ACTIVE[0] };
            constraint.value <= share * constraint.length
        };
        let row = |&Constraint { vertices, gradients, .. }: &Constraint| Row { vertices, gradients };
        let rows: Vec<Row> = constraints.iter().filter(active).map(row).collect();
        nonnegative::residual(&rows, &weights, (0..x.len()).map(way).collect(), self.iterations)
    }
}
