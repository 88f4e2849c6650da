//! Random numbers, for the tests of this crate and of `baselines`.

use bowknot_geometry::Vector;

/// Seeded random numbers.
pub struct Draw(fastrand::Rng);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [-1, 1).
    pub fn next(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    pub fn vector(&mut self) -> Vector {
        Vector::new(self.next(), self.next(), self.next())
    }
}
