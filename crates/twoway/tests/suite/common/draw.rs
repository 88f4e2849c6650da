//! Random numbers, for the tests of this crate and of `baselines`.

use bowknot_geometry::Vector;

/// Pseudorandom numbers from -1 to 1, the same in every run.
pub struct Draw(pub u64);

impl Draw {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self) -> Vector {
        Vector::new(self.next(), self.next(), self.next())
    }
}
