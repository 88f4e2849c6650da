//! Energies of springs.

use super::springs::Repulsion;
use super::state::Friction;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;

impl Repulsion {
    /// Energy at positions `x` of the watched nodes [J], up to a constant.
    pub fn energy(&self, x: &[Vector]) -> f64 {
        let partial: Vec<f64> = (0..self.springs.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let springs = chunk * CHUNK..((chunk + 1) * CHUNK).min(self.springs.len());
                springs.map(|s| self.spring_energy(s, x)).sum()
            })
            .collect();
        partial.iter().sum()
    }

    /// Energy at positions `x` of the watched nodes [J] that pressed springs could release; friction is left out.
    pub fn stored_energy(&self, x: &[Vector]) -> f64 {
        let energy = |spring: usize| {
            let state = &self.states[spring];
            if state.stiffness == 0.0 {
                return 0.0;
            }
            let pressed = self.depth_and_slip(spring, x).0 + state.lambda / state.stiffness;
            0.5 * state.stiffness * pressed.max(0.0).powi(2)
        };
        (0..self.springs.len()).map(energy).sum()
    }

    fn spring_energy(&self, spring: usize, x: &[Vector]) -> f64 {
        let state = &self.states[spring];
        let k = state.stiffness;
        if k == 0.0 || (self.guessed && !state.active) {
            return 0.0;
        }
        let (depth, slip) = self.depth_and_slip(spring, x);
        let pressed = depth + state.lambda / k;
        if self.guessed {
            let friction = match state.friction {
                Friction::None => 0.0,
                Friction::Stick(tau) => 0.5 * k * (slip - tau / k).norm_squared(),
                Friction::Slide(direction, bound, curvature) => {
                    let along = direction.dot(&slip);
                    bound * along + 0.5 * curvature * (slip.norm_squared() - along * along)
                }
            };
            return 0.5 * k * pressed * pressed + friction;
        }
        let pushed = 0.5 * k * pressed.max(0.0).powi(2);
        let trial = (state.tau() - slip * k).norm();
        pushed
            + match state.friction {
                Friction::None => 0.0,
                _ if trial <= state.friction_bound => 0.5 * trial * trial / k,
                _ => state.friction_bound * (trial - 0.5 * state.friction_bound) / k,
            }
    }
}
