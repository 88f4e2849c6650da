//! Positions from multipliers.

use crate::error::LcpError;
use crate::problem::LcpProblem;
use crate::state::LcpState;

/// y += W (J^T lambda + multipliers of distance limits + friction), over all constraints, scheduled or not.
///
/// Call it with `y` = y_free to start the solvers from kept multipliers. The multiplier of a row does nothing
/// if none of its nodes can move.
///
/// # Errors
/// [`LcpError::Length`] if the state does not fit the problem.
pub fn apply_multipliers(problem: &LcpProblem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
    state.check(problem)?;
    let weights = problem.weights();
    let y = &mut *state.y;
    for (edge, multiplier) in problem.distance_limits().rows.iter().zip(&*state.limit_multipliers) {
        let [a, b] = edge.vertices.map(|v| v as usize);
        y[a] -= weights[a] * multiplier;
        y[b] += weights[b] * multiplier;
    }
    for (row, &lambda) in problem.rows().rows.iter().zip(&*state.lambda) {
        if lambda != 0.0 {
            for (&node, gradient) in row.vertices.iter().zip(&row.gradients) {
                y[node as usize] += gradient * (weights[node as usize] * lambda);
            }
        }
    }
    for (row, lambda) in problem.friction().rows.iter().zip(&*state.friction) {
        let direction = row.direction(*lambda);
        for (&node, &coefficient) in row.vertices.iter().zip(&row.coefficients) {
            y[node as usize] += direction * (weights[node as usize] * coefficient);
        }
    }
    Ok(())
}
