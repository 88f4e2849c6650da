//! The check of colors.

use crate::error::LcpError;
use crate::problem::LcpProblem;
use crate::rows::Constraint;
use crate::schedule::ConstraintSet;

/// Checks that no two constraints of one color share a node that can move, unless they are in the same cluster.
/// A constraint may name a node several times. Cost: one pass, and three numbers per node.
///
/// # Errors
/// [`LcpError::Color`] for the first clash.
pub fn validate_colors(problem: &LcpProblem<'_>) -> Result<(), LcpError> {
    let weights = problem.weights();
    let mut last = vec![Use::default(); weights.len()];
    let mut stamp = 0;
    validate_set(problem.distance_limits(), weights, &mut last, &mut stamp)?;
    validate_set(problem.rows(), weights, &mut last, &mut stamp)?;
    validate_set(problem.friction(), weights, &mut last, &mut stamp)
}

/// Where a node was used last.
#[derive(Clone, Copy, Default)]
struct Use {
    /// Every color of every set has a stamp of its own, from 1.
    stamp: usize,
    /// The cluster, or the place where there are no clusters.
    unit: usize,
    place: usize,
}

fn validate_set<T: Constraint>(
    set: ConstraintSet<'_, T>,
    weights: &[f64],
    last: &mut [Use],
    stamp: &mut usize,
) -> Result<(), LcpError> {
    for (color, ends) in set.schedule.starts.windows(2).enumerate() {
        *stamp += 1;
        for unit in ends[0] as usize..ends[1] as usize {
            for place in set.schedule.places(unit..unit + 1) {
                let second = set.schedule.row(place);
                // The same constraint twice in a color is a clash too, so units are compared.
                for &node in set.rows[second].nodes() {
                    let seen = &mut last[node as usize];
                    if weights[node as usize] != 0.0 && seen.stamp == *stamp && seen.unit != unit {
                        let first = set.schedule.row(seen.place);
                        return Err(LcpError::Color { constraint: T::NAME, color, first, second, node });
                    }
                    *seen = Use { stamp: *stamp, unit, place };
                }
            }
        }
    }
    Ok(())
}
