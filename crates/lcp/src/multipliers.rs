//! From multipliers to positions.

use crate::Error;
use crate::problem::{Problem, State};

/// y += W (J^T lambda + ball forces + friction), with all rows, scheduled or not. Give `y` = y_free to
/// start the solvers from kept multipliers. Multipliers of rows none of whose nodes can move do
/// nothing.
///
/// # Errors
/// [`Error::Length`] if the state does not fit the problem.
pub fn apply_multipliers(problem: &Problem<'_>, state: &mut State<'_>) -> Result<(), Error> {
    state.check(problem)?;
    let weights = problem.weights();
    let y = &mut *state.y;
    for (ball, force) in problem.balls().rows.iter().zip(&*state.forces) {
        let [a, b] = ball.vertices.map(|v| v as usize);
        y[a] -= weights[a] * force;
        y[b] += weights[b] * force;
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
