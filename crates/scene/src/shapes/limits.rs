//! Ranges that many shapes have in common.

use bowknot_errors::Checks;

/// More vertices than this in one shape are refused: a mistyped edge length rather than a wish.
pub(super) const MAX_VERTICES: f64 = 2e7;

/// Refuses lengths that are not above 0; whether all are.
pub(super) fn positive_lengths(
    lengths: impl IntoIterator<Item = (&'static str, f64)>,
    checks: &mut Checks,
) -> bool {
    let before = checks.error_count();
    for (field, value) in lengths {
        let fits = value.is_finite() && value > 0.0;
        checks.require(fits, field, value, "must be a length in meters above 0");
    }
    checks.error_count() == before
}

/// Refuses an edge length [m] that makes too many vertices.
pub(super) fn limit_vertices(vertices: f64, edge: f64, checks: &mut Checks) {
    let allowed = format!("must be larger: it would make more than {MAX_VERTICES:e} vertices");
    checks.require(vertices <= MAX_VERTICES || vertices.is_nan(), "edge", format!("{edge} m"), allowed);
}
