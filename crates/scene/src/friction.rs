//! Friction of pairs of bodies.

use bowknot_errors::{Checks, Parameters};
use serde::{Deserialize, Serialize};

/// Friction between two bodies, `[[contact.friction_pairs]]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FrictionPair {
    /// Names of two bodies or obstacles; twice the same for a body's contacts with itself.
    pub bodies: [String; 2],
    /// Coefficient of Coulomb friction between them [1], at least 0, in place of the geometric mean of their own.
    /// Default 0.
    pub friction: f64,
}

impl Parameters for FrictionPair {
    fn check(&self, checks: &mut Checks) {
        checks.non_negative("friction", self.friction);
    }
}
