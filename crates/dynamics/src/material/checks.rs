//! Checks of values with a unit, which error messages name.

use bowknot_errors::Checks;

/// A field with its value and its unit.
pub(super) type Field = (&'static str, f64, &'static str);

/// Each value must be finite and above 0.
pub(super) fn positive(checks: &mut Checks, fields: &[Field]) {
    for &(field, value, unit) in fields {
        let fits = value > 0.0 && value.is_finite();
        checks.require(fits, field, format!("{value} {unit}"), "must be finite and above 0");
    }
}

/// Each value must be finite and at least 0.
pub(super) fn non_negative(checks: &mut Checks, fields: &[Field]) {
    for &(field, value, unit) in fields {
        let fits = value >= 0.0 && value.is_finite();
        checks.require(fits, field, format!("{value} {unit}"), "must be finite and at least 0");
    }
}
