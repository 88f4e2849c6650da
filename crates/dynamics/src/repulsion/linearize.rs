//! Force and Hessian of each active spring.

use super::springs::Repulsion;
use super::state::Friction;
use crate::linear::springs::LinearSpring;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

impl Repulsion {
    /// Linearizes the active springs with watched nodes at `x`.
    pub fn linearize(&mut self, x: &[Vector]) {
        let active: Vec<u32> =
            (0..self.springs.len() as u32).filter(|&s| self.states[s as usize].active).collect();
        let mut linear = std::mem::take(&mut self.linear);
        linear.set(|springs| {
            active.par_iter().map(|&s| self.linearized(s as usize, x)).collect_into_vec(springs);
        });
        self.linear = linear;
    }

    fn linearized(&self, spring: usize, x: &[Vector]) -> LinearSpring {
        let (state, n) = (&self.states[spring], self.springs[spring].normal);
        let k = state.stiffness;
        let (depth, slip) = self.depth_and_slip(spring, x);
        let along_normal = n * n.transpose();
        let across = || Matrix3::identity() - along_normal;
        let (mut hessian, mut force) = (along_normal * k, n * (state.lambda + k * depth));
        match state.friction {
            Friction::None => {}
            Friction::Slide(direction, bound, curvature) if self.guessed => {
                let beside = across() - direction * direction.transpose();
                hessian += beside * curvature;
                force -= direction * bound + beside * slip * curvature;
            }
            _ => {
                let trial = state.tau() - slip * k;
                let size = trial.norm();
                if self.guessed || size <= state.friction_bound {
                    hessian += across() * k;
                    force += trial;
                } else {
                    let direction = trial / size;
                    hessian +=
                        (across() - direction * direction.transpose()) * (k * state.friction_bound / size);
                    force += direction * state.friction_bound;
                }
            }
        }
        LinearSpring { nodes: self.nodes[spring], weights: self.springs[spring].weights, hessian, force }
    }
}
