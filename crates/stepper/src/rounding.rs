//! By how much floating point may reduce a certified gap in one step.

/// Absolute rounding bounds at the scale of a scene's coordinates.
///
/// Let u = 2^-53, ulp(C) = 2 u C, and C the largest coordinate before or after a step, at least twice the
/// longest travel. The update x + alpha d is rounded twice, by at most u |alpha d| + u |x'| <= 1.5 u C in
/// each component, which is less than 1.5 sqrt(3) u C = 1.3 ulp(C) along any unit vector. The closing speed n
/// . d, from which a share is computed, is off by at most 4 u |d|, and its factor for the cap of the travel,
/// the shares and the division that makes alpha of them round five times more: 9 u C/2 = 2.25 ulp(C) over the
/// travel of a step. `step` = 4 ulp(C) covers both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// By how much, at most, one side closes a gap beyond its share in one step [m].
    pub step: f64,
    /// Gap at or below which a pair's vertices must not move at all [m]. Above it, a step that is not meant
    /// to close the gap cannot close it by rounding.
    pub frozen: f64,
}

impl Rounding {
    /// Bounds for coordinates up to `largest_coordinate` [m] in absolute value.
    pub fn new(largest_coordinate: f64) -> Self {
        let ulp = f64::EPSILON * largest_coordinate;
        Self { step: 4.0 * ulp, frozen: 9.0 * ulp }
    }

    /// Gap at or below which the isotropic bound, which halves it again and again, moves nothing: 64 ulp [m].
    pub fn touching(&self) -> f64 {
        16.0 * self.step
    }

    /// Smallest value of a minimum separation that exceeds rounding: 16 ulp [m].
    pub fn smallest_min_separation(largest_coordinate: f64) -> f64 {
        16.0 * f64::EPSILON * largest_coordinate
    }
}
