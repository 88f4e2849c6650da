//! Residuals: how far a state is from solving its problem.

use crate::error::LcpError;
use crate::kernels::{friction_multiplier, limit_multiplier, row_multiplier};
use crate::params::FrictionBound;
use crate::problem::LcpProblem;
use crate::state::LcpState;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Largest residuals over all constraints, scheduled or not. A constraint is left out if none of its nodes
/// can move: no solver could change it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Residuals {
    /// Largest |lambda - clamp(lambda - s, 0, upper)| of a row, which is |min(lambda, s)| for a hard row: it
    /// is zero exactly where lambda >= 0, s >= 0 and lambda s = 0. It compares lambda with s as the paper
    /// does: with inverse weights near 1 both have the same unit.
    pub complementarity: f64,
    /// Largest violation of a row: max(0, -s).
    pub penetration: f64,
    /// Largest |y_a - y_b| - L of a distance limit, or 0.
    pub limit_violation: f64,
    /// Largest correction that a distance limit alone would make to y_a - y_b. Unlike the violation it also
    /// counts multipliers of limits that are slack or whose direction has changed.
    pub limit_correction: f64,
    /// Largest correction that a friction row alone would make to its slip.
    pub friction_correction: f64,
}

/// The residuals of a state. Cost: a sweep without writes.
///
/// # Errors
/// [`LcpError::Length`] if the state does not fit the problem.
pub fn residuals(
    problem: &LcpProblem<'_>,
    state: &LcpState<'_>,
    friction_bound: FrictionBound,
) -> Result<Residuals, LcpError> {
    state.check(problem)?;
    let (weights, y) = (problem.weights(), &*state.y);
    let mut result = Residuals::default();
    let raise = |largest: &mut f64, value: f64| *largest = largest.max(value);
    for (row, &lambda) in problem.rows().rows.iter().zip(&*state.lambda) {
        if row.inverse_diagonal != 0.0 {
            let value = row.value(y);
            raise(&mut result.penetration, -value);
            raise(&mut result.complementarity, (lambda - row_multiplier(row, value, lambda, 1.0)).abs());
        }
    }
    for (edge, &multiplier) in problem.distance_limits().rows.iter().zip(&*state.limit_multipliers) {
        let [a, b] = edge.vertices.map(|v| v as usize);
        let total = weights[a] + weights[b];
        if total != 0.0 && a != b {
            let difference = y[a] - y[b];
            raise(&mut result.limit_violation, difference.norm() - edge.limit);
            let change = limit_multiplier(edge, difference, multiplier, total) - multiplier;
            raise(&mut result.limit_correction, change.norm() * total);
        }
    }
    for (row, &old) in problem.friction().rows.iter().zip(&*state.friction) {
        if row.inverse_diagonal != 0.0 {
            let normal = state.lambda[row.normal as usize];
            let new =
                friction_multiplier(row, row.point(y), old, normal, row.inverse_diagonal, friction_bound);
            raise(&mut result.friction_correction, (new - old).norm() / row.inverse_diagonal);
        }
    }
    Ok(result)
}
