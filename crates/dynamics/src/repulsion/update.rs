//! What changes between Newton iterations: bends of laws and bounds of friction.

use super::law::MIN_BEND;
use super::spring::SpringKind;
use super::springs::Repulsion;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Factor of a bend that a contact was pressed below. Smaller: the exact law is reached in fewer iterations,
/// but each step is to a stiffer law.
const BEND_FACTOR: f64 = 0.5;

impl Repulsion {
    /// Takes over watched nodes at `x`, the end of a Newton step. Bounds of friction become those of the
    /// normal forces there, laws that a contact was pressed below the bend of bend later, and predictions
    /// end. Returns by how much the linear forces of the step were off, summed over springs, as a share of
    /// the sum of the normal forces at `x`.
    pub fn update(&mut self, x: &[Vector]) -> f64 {
        let mut states = std::mem::take(&mut self.states);
        let of_springs = states.par_iter_mut().enumerate().with_min_len(CHUNK);
        let changes: Vec<[f64; 2]> = of_springs
            .map(|(spring, state)| {
                if !state.acts {
                    return [0.0; 2];
                }
                let (gap, slip) = self.gap_and_slip(spring, x);
                let [at, force, stiffness] = state.model;
                let modeled = force + stiffness * (at - gap);
                state.predicted = false;
                let ahead = state.slip_ahead.take();
                let bends = self.springs[spring].kind != SpringKind::Repulsion;
                if bends && state.law.share(gap) < state.law.bend() {
                    state.law.bend_at((BEND_FACTOR * state.law.bend()).max(MIN_BEND));
                }
                let right = state.push(gap).force;
                let before = match ahead {
                    Some(ahead) => {
                        let n = self.springs[spring].normal;
                        let rub = state.linear_rub(ahead, &(Matrix3::identity() - n * n.transpose()), false);
                        rub.force - rub.matrix * (slip - ahead)
                    }
                    None => state.rub(&slip, state.bound).force,
                };
                state.bound = self.springs[spring].friction * right;
                let after = state.rub(&slip, state.bound).force;
                [right, (right - modeled).abs() + (after - before).norm()]
            })
            .collect();
        self.states = states;
        // In order: the same bits for any number of threads.
        let right: f64 = changes.iter().map(|change| change[0]).sum();
        let wrong: f64 = changes.iter().map(|change| change[1]).sum();
        if wrong > 0.0 { wrong / right.max(f64::MIN_POSITIVE) } else { 0.0 }
    }
}
