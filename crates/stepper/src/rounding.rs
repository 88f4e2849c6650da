//! What floating point may take away from a certified gap in one step.

/// Absolute rounding bounds at the scale of a scene's coordinates.
///
/// With u = 2^-53 and C the largest coordinate before or after a step: the update x + alpha d is rounded
/// twice, by at most u |alpha d| + u |x'| <= 2 u C in each component where |alpha d| <= C, hence by less than
/// 2 sqrt(3) u C = 1.74 ulp(C) along any unit vector, where ulp(C) = 2 u C; the closing speed n . d that a share
/// was computed from is itself off by at most 4 u |d|, scaled by alpha to the travel of one step, which budgets
/// keep below C. `step` = 4 ulp(C) covers both, and the division that makes alpha from a share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// Bound of how much one side may close a gap beyond its share in one step [m].
    pub step: f64,
    /// Gap at or below which a pair's vertices must not move at all [m]: above it a step that closes nothing on
    /// purpose cannot reach zero by rounding.
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

    /// Smallest gap floor that stands out of rounding [m]: 16 ulp.
    pub fn smallest_floor(largest_coordinate: f64) -> f64 {
        16.0 * f64::EPSILON * largest_coordinate
    }
}
