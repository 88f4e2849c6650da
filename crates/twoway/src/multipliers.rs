//! What pairs carry from one call to the next.

use bowknot_geometry::{PairKind, Vector};

/// What a contact carries at the end of a call, and at the start of the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairMultipliers {
    /// The pair's kind.
    pub kind: PairKind,
    /// The pair's elements, as [`bowknot_proximity::Pair`] has them.
    pub elements: [u32; 2],
    /// Multiplier of the contact row [m, in units of relative mass].
    pub normal: f64,
    /// Friction multiplier, in space [m, in units of relative mass].
    pub friction: Vector,
}

impl PairMultipliers {
    /// Whether all numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.normal.is_finite() && self.friction.iter().all(|c| c.is_finite())
    }
}
