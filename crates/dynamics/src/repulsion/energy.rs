//! Energies of springs.

use super::springs::Repulsion;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

impl Repulsion {
    /// Energy at positions `x` of the watched nodes [J], up to a constant. Its negative gradient is the force
    /// that [`Self::linearize`] finds there, as long as no [`Self::update`] is between.
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

    fn spring_energy(&self, spring: usize, x: &[Vector]) -> f64 {
        let state = &self.states[spring];
        if !state.acts {
            return 0.0;
        }
        let (gap, slip) = self.gap_and_slip(spring, x);
        let friction = match state.slip_ahead {
            // The quadratic model where inertia leads.
            Some(ahead) if state.bound > 0.0 => {
                let n = self.springs[spring].normal;
                let rub = state.linear_rub(ahead, &(Matrix3::identity() - n * n.transpose()), false);
                let way = slip - ahead;
                0.5 * way.dot(&(rub.matrix * way)) - rub.force.dot(&way)
            }
            _ => state.rub(&slip, state.bound).energy,
        };
        state.push_energy(gap) + friction
    }
}
