//! Checks of lengths and numbers that callers give.

use crate::error::ResolveError;
use bowknot_geometry::Point;
use bowknot_proximity::CollisionModel;

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
    match positions.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        Some(vertex) => Err(ResolveError::NonFinite { what, vertex, body: model.vertex_body()[vertex] }),
        None => Ok(()),
    }
}
