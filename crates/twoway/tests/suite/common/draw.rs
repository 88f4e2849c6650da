//! Random numbers, for the tests of this crate and of `baselines`.

use bowknot_geometry::Vector;

/// Seeded random numbers from a linear congruential generator. Tests pin step counts that depend on these
/// numbers, so the generator must not change with the version of a dependency.
pub struct Draw(u64);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [-1, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> Vector {
        Vector::new(self.next(), self.next(), self.next())
    }
}
