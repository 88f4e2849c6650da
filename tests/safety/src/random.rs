//! Seeded random numbers, vectors and points (splitmix64, Steele, Lea and Flood 2014).
//!
//! Not from a library: the irregular ground, whose figures the documents quote, depends on these numbers.

use bowknot_geometry::{Point, Vector};

/// Random numbers from a seed, the same on every machine.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator; different seeds give unrelated numbers.
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed);
        random.bits();
        random
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, `end`).
    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end.max(1) as u64) as usize
    }

    /// Uniform in [`low`, `high`).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// Log-uniform in [`low`, `high`), both positive.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// Uniform in the cube [-`half`, `half`)^3.
    pub fn vector(&mut self, half: f64) -> Vector {
        Vector::new(self.between(-half, half), self.between(-half, half), self.between(-half, half))
    }

    /// A unit vector, uniform to the bias of a cube's corners.
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
