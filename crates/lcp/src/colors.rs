//! The check of colors.

use crate::error::LcpError;
use crate::problem::LcpProblem;
use crate::rows::Constraint;
use crate::schedule::ConstraintSet;

/// Checks that no two constraints of one color share a node that can move. A constraint may name a node
/// several times. Cost: one pass, and two numbers per node.
///
/// # Errors
/// [`LcpError::Color`] for the first clash.
pub fn validate_colors(problem: &LcpProblem<'_>) -> Result<(), LcpError> {
    let weights = problem.weights();
    // Stamp and place that last used each node. Every color of every set has a stamp of its own.
    let mut last = vec![(0_usize, 0_usize); weights.len()];
    let mut stamp = 0;
    validate_set(problem.distance_limits(), weights, &mut last, &mut stamp)?;
    validate_set(problem.rows(), weights, &mut last, &mut stamp)?;
    validate_set(problem.friction(), weights, &mut last, &mut stamp)
}

fn validate_set<T: Constraint>(
    set: ConstraintSet<'_, T>,
    weights: &[f64],
    last: &mut [(usize, usize)],
    stamp: &mut usize,
) -> Result<(), LcpError> {
    for (color, ends) in set.schedule.starts.windows(2).enumerate() {
        *stamp += 1;
        for place in ends[0] as usize..ends[1] as usize {
            let second = set.schedule.row(place);
            // The same constraint twice in a color is a clash too, so places are compared.
            for &node in set.rows[second].nodes() {
                let seen = &mut last[node as usize];
                if weights[node as usize] != 0.0 && seen.0 == *stamp && seen.1 != place {
                    let first = set.schedule.row(seen.1);
                    return Err(LcpError::Color { constraint: T::NAME, color, first, second, node });
                }
                *seen = (*stamp, place);
            }
        }
    }
    Ok(())
}
