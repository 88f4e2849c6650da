//! Checking colours.

use crate::Error;
use crate::problem::{AnyRow, Family, Problem};

/// Checks that no two rows of a colour, of any family, share a node that can move. A node that stands
/// in several places of one row is no clash. Cost: one pass and two numbers a node.
///
/// # Errors
/// [`Error::Colour`] for the first clash.
pub fn validate_colours(problem: &Problem<'_>) -> Result<(), Error> {
    let weights = problem.weights();
    // Stamp and row that last used each node; stamps go on over families.
    let mut last = vec![(0_usize, 0_usize); weights.len()];
    let mut stamp = 0;
    validate_family(problem.balls(), weights, &mut last, &mut stamp)?;
    validate_family(problem.rows(), weights, &mut last, &mut stamp)?;
    validate_family(problem.friction(), weights, &mut last, &mut stamp)
}

fn validate_family<T: AnyRow>(
    family: Family<'_, T>,
    weights: &[f64],
    last: &mut [(usize, usize)],
    stamp: &mut usize,
) -> Result<(), Error> {
    for (colour, ends) in family.schedule.starts.windows(2).enumerate() {
        *stamp += 1;
        for place in ends[0] as usize..ends[1] as usize {
            let second = family.schedule.row(place);
            // The same row twice in a colour is a clash too: places tell them apart.
            for &node in family.rows[second].nodes() {
                let seen = &mut last[node as usize];
                if weights[node as usize] != 0.0 && seen.0 == *stamp && seen.1 != place {
                    let first = family.schedule.row(seen.1);
                    return Err(Error::Colour { family: T::NAME, colour, first, second, node });
                }
                *seen = (*stamp, place);
            }
        }
    }
    Ok(())
}
