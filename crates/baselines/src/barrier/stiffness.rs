//! The stiffness of the barrier of IPC and how it adapts (Li et al. 2020 and its supplement).

use super::function::barrier;
use bowknot_twoway::geometry::Vector;

/// Smallest stiffness: that at which the curvature at `TIGHT` of the diagonal is this times the mean mass.
const MIN_CURVATURE: f64 = 1e11;
/// See [`MIN_CURVATURE`].
const TIGHT: f64 = 1e-8;
/// Largest stiffness over the smallest.
const LARGEST: f64 = 100.0;
/// The stiffness doubles where the smallest distance is below this share of the diagonal and shrinks.
const DIFFICULT: f64 = 1e-9;

/// The stiffness during a call.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AdaptiveStiffness {
    /// kappa over the square of the time step, as the objective is in joules [kg/(m^2 s^2)].
    pub value: f64,
    largest: f64,
    /// Diagonal of the scene's bounding box [m].
    diagonal: f64,
    /// Smallest distance at the last update [m].
    smallest: f64,
}

impl AdaptiveStiffness {
    /// At the start of a call: that which balances the gradient of the energy and the gradient of the barrier
    /// with a stiffness of 1, within bounds. `inertia` is the mean mass over the square of the time step.
    pub fn balanced(
        diagonal: f64,
        range: f64,
        inertia: f64,
        energy: &[Vector],
        of_barrier: &[Vector],
    ) -> Self {
        let square = range * range;
        let tight = (TIGHT * diagonal).powi(2).min(0.5 * square);
        let least = MIN_CURVATURE * inertia / (4.0 * tight * barrier(1.0, tight, square).curvature);
        let dot = |a: &[Vector], b: &[Vector]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
        let norm = dot(of_barrier, of_barrier);
        let balance = if norm > 0.0 { -dot(of_barrier, energy) / norm } else { 0.0 };
        let largest = LARGEST * least;
        Self { value: balance.clamp(least, largest), largest, diagonal, smallest: f64::INFINITY }
    }

    /// After a step: doubles the stiffness if the barrier has difficulty to push pairs apart. `smallest` is
    /// the smallest distance of a pair [m].
    pub fn update(&mut self, smallest: f64) {
        let threshold = DIFFICULT * self.diagonal;
        if smallest < threshold && self.smallest < threshold && smallest < self.smallest {
            self.value = (2.0 * self.value).min(self.largest);
        }
        self.smallest = smallest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_gradients_balance_where_the_bounds_allow() {
        let start = |force: f64| {
            let (pull, push) = (Vector::new(0.0, 0.0, force), Vector::new(0.0, 0.0, -2.0));
            AdaptiveStiffness::balanced(1.0, 1e-3, 1e-3, &[pull], &[push])
        };
        let least = start(0.0).value;
        let balanced = start(2.0 * 10.0 * least);
        assert!((balanced.value / (10.0 * least) - 1.0).abs() < 1e-12, "{balanced:?}");
        assert_eq!(start(1e30).value, 100.0 * least);
        // Forces that pull apart.
        assert_eq!(start(-1.0).value, least);
        // 1e11 m/h^2 = 4 kappa d0 b''(d0) at d0 = 1e-16, with b'' near (R/d0)^2.
        let expected = 1e11 * 1e-3 / (4.0 * 1e-16 * 1e20);
        assert!((least / expected - 1.0).abs() < 1e-6, "{least} {expected}");
    }

    #[test]
    fn it_doubles_while_a_tiny_distance_shrinks() {
        let mut stiffness = AdaptiveStiffness::balanced(1.0, 1e-3, 1e-3, &[], &[]);
        let least = stiffness.value;
        let mut after = |smallest: f64| {
            stiffness.update(smallest);
            stiffness.value / least
        };
        let factors = [1e-5, 0.9e-9, 0.8e-9, 0.85e-9, 0.7e-9, 1e-4, 0.6e-9].map(&mut after);
        assert_eq!(factors, [1.0, 1.0, 2.0, 2.0, 4.0, 4.0, 4.0]);
        (0..20).for_each(|k| _ = after(0.5e-9 - f64::from(k) * 1e-11));
        assert_eq!(after(1e-12), 100.0);
    }
}
