//! Seeded random numbers, vectors and points.

use bowknot_geometry::{Point, Vector};
use fastrand::Rng;

/// Random numbers from a seed, the same on every machine.
#[derive(Clone, Debug)]
pub struct Random(Rng);

impl Random {
    /// A generator. Different seeds give unrelated numbers.
    pub fn new(seed: u64) -> Self {
        Self(Rng::with_seed(seed))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0.u64(..)
    }

    /// Uniform in [0, `end`); 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        self.0.usize(..end.max(1))
    }

    /// Uniform in [`low`, `high`).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    /// Log-uniform in [`low`, `high`), both positive.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Uniform in the cube [-`half`, `half`)^3.
    pub fn vector(&mut self, half: f64) -> Vector {
        Vector::new(self.between(-half, half), self.between(-half, half), self.between(-half, half))
    }

    /// A unit vector. Directions toward the corners of a cube are more frequent.
    pub fn direction(&mut self) -> Vector {
        loop {
            let v = self.vector(1.0);
            if let Some(unit) = v.try_normalize(0.1) {
                return unit;
            }
        }
    }

    /// A point in the cube [-`half`, `half`)^3.
    pub fn point(&mut self, half: f64) -> Point {
        Point::from(self.vector(half))
    }
}
