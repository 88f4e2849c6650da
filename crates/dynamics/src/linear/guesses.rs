//! Where a linear solve starts.
//!
//! In double precision, whatever the solve computes in: inertia leads a body in free flight all but exactly to where it goes,
//! which may be a thousand times its size away in a time step, and single precision would tear it.

use super::parts::Parts;
use super::system::System;
use bowknot_geometry::Vector;

/// Buffers for guesses.
#[derive(Debug, Default)]
pub(super) struct Guesses {
    tried: Vec<Guess>,
}

/// A direction, its image under H and its curvatures.
#[derive(Debug, Default)]
struct Guess {
    direction: Vec<Vector>,
    image: Vec<Vector>,
    /// By part.
    curvatures: Vec<f64>,
}

impl Guesses {
    /// Moves `x` from zero to the combination of `guesses` with the least energy, part by part, and `residual` from b to b - H x.
    pub fn start(
        &mut self,
        system: &System<'_>,
        parts: &Parts,
        guesses: &[&[Vector]],
        x: &mut [Vector],
        residual: &mut [Vector],
    ) {
        if self.tried.len() < guesses.len() {
            self.tried.resize_with(guesses.len(), Guess::default);
        }
        for (k, guess) in guesses.iter().enumerate() {
            let (before, rest) = self.tried.split_at_mut(k);
            let Guess { direction: p, image: q, curvatures } = &mut rest[0];
            p.clear();
            p.extend_from_slice(guess);
            q.resize(p.len(), Vector::zeros());
            system.multiply(p, q);
            *curvatures = parts.dot(p, q);
            // Made conjugate to the guesses before.
            for other in before.iter() {
                let shares = along(&parts.dot(p, &other.image), &other.curvatures, -1.0);
                parts.add_scaled(p, &shares, &other.direction);
                parts.add_scaled(q, &shares, &other.image);
                *curvatures = parts.dot(p, q);
            }
            let steps = along(&parts.dot(p, residual), curvatures, 1.0);
            parts.add_scaled(x, &steps, p);
            let back: Vec<f64> = steps.iter().map(|step| -step).collect();
            parts.add_scaled(residual, &back, q);
        }
    }
}

/// How far to go along a direction, by part: `sign` times the product over the curvature; not at all where that is not positive.
fn along(products: &[f64], curvatures: &[f64], sign: f64) -> Vec<f64> {
    let step = |(product, curvature): (&f64, &f64)| {
        if is_positive(*curvature) { sign * product / curvature } else { 0.0 }
    };
    products.iter().zip(curvatures).map(step).collect()
}

fn is_positive(curvature: f64) -> bool {
    curvature > 0.0 && curvature.is_finite()
}
