//! Parameters out of their range.

use crate::Errors;
use std::error::Error;
use std::fmt;

/// A parameter out of its range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParamError {
    /// Path of the parameter from the struct that was validated, such as `stop.distance`.
    pub path: String,
    /// Its value, as text; empty if it is missing, or wrong only beside another parameter.
    pub value: String,
    /// What is allowed, "must be ...", or what is missing or contradicts.
    pub allowed: String,
}

impl fmt::Display for ParamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.value.is_empty() {
            write!(f, "{}: {}", self.path, self.allowed)
        } else {
            write!(f, "{} = {}: {}", self.path, self.value, self.allowed)
        }
    }
}

impl Error for ParamError {}

/// A struct of parameters, every field of which can be checked.
pub trait Parameters {
    /// Checks every field.
    fn check(&self, checks: &mut Checks);

    /// Checks every field.
    ///
    /// # Errors
    /// One error for each field out of its range.
    fn validate(&self) -> Result<(), Errors<ParamError>> {
        let mut checks = Checks::default();
        self.check(&mut checks);
        checks.finish()
    }
}

/// Collects the errors of a struct of parameters. Its methods refuse NaN. Texts are written for errors alone,
/// so that checks that succeed allocate nothing.
#[derive(Debug, Default)]
pub struct Checks {
    /// Path of the struct that is being checked, with a dot at its end unless it is empty.
    prefix: String,
    errors: Vec<ParamError>,
}

impl Checks {
    /// Refuses `value` unless `fits`; `allowed` says what is allowed, "must be ...".
    pub fn require(&mut self, fits: bool, field: &str, value: impl fmt::Display, allowed: impl fmt::Display) {
        if !fits {
            let path = format!("{}{field}", self.prefix);
            self.errors.push(ParamError { path, value: value.to_string(), allowed: allowed.to_string() });
        }
    }

    /// Refuses `value`; `allowed` says what is allowed, "must be ...".
    pub fn refuse(&mut self, field: &str, value: impl fmt::Display, allowed: impl fmt::Display) {
        self.require(false, field, value, allowed);
    }

    /// Refuses a field that is missing or that contradicts another; `message` says which, and the remedy.
    pub fn contradiction(&mut self, field: &str, message: impl fmt::Display) {
        self.refuse(field, "", message);
    }

    /// Number of errors so far, in all structs that have been checked.
    pub fn error_count(&self) -> usize {
        self.errors.len()
    }

    /// The value must be finite.
    pub fn finite(&mut self, field: &str, value: f64) {
        self.require(value.is_finite(), field, value, "must be finite");
    }

    /// The value must be finite and above 0.
    pub fn positive(&mut self, field: &str, value: f64) {
        self.above(field, value, 0.0);
    }

    /// The value must be finite and at least 0.
    pub fn non_negative(&mut self, field: &str, value: f64) {
        self.at_least(field, value, 0.0);
    }

    /// The value must be finite and at least `least`.
    pub fn at_least(&mut self, field: &str, value: f64, least: f64) {
        let fits = value.is_finite() && value >= least;
        self.require(fits, field, value, format_args!("must be finite and at least {least}"));
    }

    /// The value must be finite and above `bound`.
    pub fn above(&mut self, field: &str, value: f64, bound: f64) {
        let fits = value.is_finite() && value > bound;
        self.require(fits, field, value, format_args!("must be finite and above {bound}"));
    }

    /// The value must be above `bound`; infinity is allowed.
    pub fn above_or_infinite(&mut self, field: &str, value: f64, bound: f64) {
        self.require(value > bound, field, value, format_args!("must be above {bound}, inf included"));
    }

    /// The value must lie between the bounds, which are not allowed themselves.
    pub fn between(&mut self, field: &str, value: f64, low: f64, high: f64) {
        let fits = value > low && value < high;
        self.require(fits, field, value, format_args!("must lie between {low} and {high}"));
    }

    /// The number must be at least `least`.
    pub fn count_at_least(&mut self, field: &str, value: usize, least: usize) {
        self.require(value >= least, field, value, format_args!("must be at least {least}"));
    }

    /// Every component must be finite.
    pub fn all_finite<'a>(&mut self, field: &str, values: impl IntoIterator<Item = &'a f64> + Clone) {
        if !values.clone().into_iter().all(|value| value.is_finite()) {
            let values: Vec<f64> = values.into_iter().copied().collect();
            self.refuse(field, format_args!("{values:?}"), "must be finite in every component");
        }
    }

    /// Checks a nested struct: its fields are named `field.name`.
    pub fn within(&mut self, field: &str, parameters: &impl Parameters) {
        let length = self.prefix.len();
        self.prefix.push_str(field);
        self.prefix.push('.');
        parameters.check(self);
        self.prefix.truncate(length);
    }

    /// The result of all checks.
    ///
    /// # Errors
    /// One error for each field out of its range.
    pub fn finish(self) -> Result<(), Errors<ParamError>> {
        Errors::check(self.errors)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Inner(f64);
    struct Outer(Inner, f64);

    impl Parameters for Inner {
        fn check(&self, checks: &mut Checks) {
            checks.positive("length", self.0);
        }
    }

    impl Parameters for Outer {
        fn check(&self, checks: &mut Checks) {
            checks.within("inner", &self.0);
            checks.between("share", self.1, 0.0, 1.0);
        }
    }

    #[test]
    fn paths_name_nested_fields_and_nan_is_refused() {
        assert!(Outer(Inner(1.0), 0.5).validate().is_ok());
        let errors = Outer(Inner(-1.0), f64::NAN).validate().expect_err("both");
        assert_eq!(
            errors.to_string(),
            "inner.length = -1: must be finite and above 0\nshare = NaN: must lie between 0 and 1"
        );
        assert_eq!(errors[0].path, "inner.length");
    }

    #[test]
    fn every_check_refuses_nan_and_infinity_unless_it_says_so() {
        let mut checks = Checks::default();
        for value in [f64::NAN, f64::INFINITY] {
            checks.finite("a", value);
            checks.positive("b", value);
            checks.non_negative("c", value);
            checks.at_least("d", value, 1.0);
            checks.above("e", value, 1.0);
            checks.between("f", value, 0.0, 1.0);
            checks.all_finite("g", &[0.0, value]);
            checks.above_or_infinite("h", value, 1.0);
        }
        checks.count_at_least("i", 0, 1);
        let errors = checks.finish().expect_err("all but infinity where it is allowed");
        assert_eq!(errors.len(), 7 * 2 + 2);
    }
}
