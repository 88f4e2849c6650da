//! Where a linear solve starts.
//!
//! In double precision, whatever the solve computes in: inertia leads a body in free flight all but exactly to where it goes,
//! which may be a thousand times its size away in a time step, and single precision would tear it.

use super::system::System;
use super::vectors::{add_scaled, dot};
use bowknot_geometry::Vector;

/// Buffers for guesses.
#[derive(Debug, Default)]
pub(super) struct Guesses {
    tried: Vec<Guess>,
}

/// A direction, its image under H and its curvature.
#[derive(Debug, Default)]
struct Guess {
    direction: Vec<Vector>,
    image: Vec<Vector>,
    curvature: f64,
}

impl Guesses {
    /// Moves `x` from zero to the combination of `guesses` with the least energy, and `residual` from b to b - H x.
    pub fn start(
        &mut self,
        system: &System<'_>,
        guesses: &[&[Vector]],
        x: &mut [Vector],
        residual: &mut [Vector],
    ) {
        if self.tried.len() < guesses.len() {
            self.tried.resize_with(guesses.len(), Guess::default);
        }
        for (k, guess) in guesses.iter().enumerate() {
            let (before, rest) = self.tried.split_at_mut(k);
            let Guess { direction: p, image: q, curvature } = &mut rest[0];
            p.clear();
            p.extend_from_slice(guess);
            q.resize(p.len(), Vector::zeros());
            *curvature = system.multiply(p, q);
            // Made conjugate to the guesses before.
            for other in before.iter().filter(|other| is_positive(other.curvature)) {
                let share = -dot(p, &other.image) / other.curvature;
                add_scaled(p, share, &other.direction);
                add_scaled(q, share, &other.image);
                *curvature = dot(p, q);
            }
            if is_positive(*curvature) {
                let step = dot(p, residual) / *curvature;
                add_scaled(x, step, p);
                add_scaled(residual, -step, q);
            }
        }
    }
}

fn is_positive(curvature: f64) -> bool {
    curvature > 0.0 && curvature.is_finite()
}
