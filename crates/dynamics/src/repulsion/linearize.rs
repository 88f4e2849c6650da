//! Force and Hessian of each spring that acts.

use super::spring::SpringKind;
use super::springs::Repulsion;
use crate::linear::springs::LinearSpring;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

impl Repulsion {
    /// Linearizes the springs that push, with watched nodes at `x`.
    pub fn linearize(&mut self, x: &[Vector], with_friction: bool) {
        let mut states = std::mem::take(&mut self.states);
        states.par_iter_mut().enumerate().with_min_len(CHUNK).for_each(|(spring, state)| {
            state.model = [0.0; 3];
            if state.acts {
                let (gap, _) = self.gap_and_slip(spring, x);
                let push = state.push(gap);
                state.model = [gap, push.force, push.stiffness];
            }
        });
        self.states = states;
        let pushes = |s: &u32| self.states[*s as usize].pushes();
        let pushing: Vec<u32> = (0..self.springs.len() as u32).filter(pushes).collect();
        let mut linear = std::mem::take(&mut self.linear);
        linear.set(|springs| {
            let linearized = |&s: &u32| {
                let model = self.states[s as usize].model;
                self.linearized(s as usize, model, x, with_friction)
            };
            pushing.par_iter().map(linearized).collect_into_vec(springs);
        });
        self.linear = linear;
    }

    /// A spring with a normal force linearized to `model`, see [`super::state::SpringState::model`].
    pub(super) fn linearized(
        &self,
        spring: usize,
        [gap, push, k]: [f64; 3],
        x: &[Vector],
        with_friction: bool,
    ) -> LinearSpring {
        let (state, n) = (&self.states[spring], self.normal(spring, x));
        let (_, slip) = self.gap_and_slip(spring, x);
        let along_normal = n * n.transpose();
        let across = Matrix3::identity() - along_normal;
        let (mut hessian, mut force) = (along_normal * k, n * push);
        if self.springs[spring].kind == SpringKind::Limit {
            // The normal turns with the ends, so a tension holds them sideways too. A pull of a predicted
            // spring would do the opposite, and is left out.
            let length = -self.springs[spring].offset - gap;
            hessian += across * (push.max(0.0) / length.max(f64::MIN_POSITIVE));
        }
        if with_friction && state.bound > 0.0 && state.grip > 0.0 {
            let rub = state.linear_rub(state.slip_ahead.unwrap_or(slip), &across, self.majorizes_friction);
            force += rub.force + rub.matrix * (rub.at - slip);
            hessian += rub.matrix;
        }
        LinearSpring { nodes: self.nodes[spring], weights: self.springs[spring].weights, hessian, force }
    }
}
