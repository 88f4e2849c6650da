//! How far a state is from solving its problem.

use crate::Error;
use crate::kernels::{ball_multiplier, friction_multiplier, row_multiplier};
use crate::params::FrictionBound;
use crate::problem::{Problem, State};
use serde::{Deserialize, Serialize};

/// What is violated, over all rows, scheduled or not; rows none of whose nodes can move are left out,
/// as nothing can be done about them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Residuals {
    /// Largest |lambda - clamp(lambda - s, 0, upper)| of a row, which is |min(lambda, s)| for a hard
    /// row: zero exactly where 0 <= lambda, s >= 0 and lambda s = 0. It mixes lambda and s as the
    /// paper does: inverse weights near 1 give both one unit.
    pub complementarity: f64,
    /// Largest violation of a row: max(0, -s).
    pub penetration: f64,
    /// Largest |y_a - y_b| - L of a ball row, or 0.
    pub ball_violation: f64,
    /// Largest correction that a ball row alone would make to y_a - y_b: unlike the violation it also
    /// sees forces on slack or turned edges.
    pub ball_correction: f64,
    /// Largest correction that a friction row alone would make to its slip.
    pub friction_correction: f64,
}

/// Judges a state. Cost: a sweep without writes.
///
/// # Errors
/// [`Error::Length`] if the state does not fit the problem.
pub fn residuals(
    problem: &Problem<'_>,
    state: &State<'_>,
    friction_bound: FrictionBound,
) -> Result<Residuals, Error> {
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
    for (ball, &force) in problem.balls().rows.iter().zip(&*state.forces) {
        let [a, b] = ball.vertices.map(|v| v as usize);
        let total = weights[a] + weights[b];
        if total != 0.0 && a != b {
            let difference = y[a] - y[b];
            raise(&mut result.ball_violation, difference.norm() - ball.limit);
            let change = ball_multiplier(ball, difference, force, total) - force;
            raise(&mut result.ball_correction, change.norm() * total);
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
