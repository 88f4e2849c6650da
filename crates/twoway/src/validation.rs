//! Checks of lengths and numbers that callers give.

use crate::error::ResolveError;
use bowknot_geometry::Point;
use bowknot_proximity::CollisionModel;
use rayon::prelude::*;

/// Points that one thread looks at, at least.
const MIN_POINTS: usize = 4096;

/// Refuses a slice without exactly one entry per vertex.
pub(crate) fn check_length(what: &'static str, given: usize, vertices: usize) -> Result<(), ResolveError> {
    if given == vertices { Ok(()) } else { Err(ResolveError::Length { what, given, vertices }) }
}

/// Refuses positions that are not finite.
pub(crate) fn check_finite(
    what: &'static str,
    model: &CollisionModel,
    positions: &[Point],
) -> Result<(), ResolveError> {
    let points = positions.par_iter().with_min_len(MIN_POINTS);
    match points.position_first(|p| !p.iter().all(|c| c.is_finite())) {
        Some(vertex) => Err(ResolveError::NonFinite { what, vertex, body: model.vertex_body()[vertex] }),
        None => Ok(()),
    }
}

/// Largest absolute coordinate [m]; coordinates that are not numbers are left out.
pub(crate) fn largest_coordinate(positions: &[Point]) -> f64 {
    let points = positions.par_iter().with_min_len(MIN_POINTS);
    points.map(|p| p.coords.amax()).reduce(|| 0.0, f64::max)
}

/// Largest number of contact and edge rows. Solvers list up to four vertices per row by indices of 32 bits.
const MAX_ROWS: usize = u32::MAX as usize / 4;

/// Refuses so many pairs within contact range that rows could not be numbered.
pub(crate) fn check_rows(pairs: usize, edges: usize) -> Result<(), ResolveError> {
    check_rows_within(pairs, edges, MAX_ROWS)
}

fn check_rows_within(pairs: usize, edges: usize, limit: usize) -> Result<(), ResolveError> {
    let fits = pairs.checked_add(edges).is_some_and(|rows| rows <= limit);
    if fits { Ok(()) } else { Err(ResolveError::TooManyRows { pairs, edges, limit }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_rows_than_can_be_numbered_are_refused_with_their_counts() {
        assert_eq!(check_rows_within(7, 3, 10), Ok(()));
        let refused = ResolveError::TooManyRows { pairs: 8, edges: 3, limit: 10 };
        assert_eq!(check_rows_within(8, 3, 10), Err(refused.clone()));
        assert!(check_rows_within(usize::MAX, 1, usize::MAX).is_err());
        let words = refused.to_string();
        for part in ["8 pairs", "3 edges", "at most 10", "contact.delta"] {
            assert!(words.contains(part), "{words}");
        }
        assert_eq!(check_rows(1 << 29, (1 << 29) - 1), Ok(()));
        // As many rows as places of 32 bits, four for each: the last would have no number.
        assert!(check_rows(1 << 30, 0).is_err());
    }
}
