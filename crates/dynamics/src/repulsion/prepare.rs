//! Stiffness of springs, and the guess of the active set that a time step starts from.

use super::springs::Repulsion;
use super::state::{Friction, SpringState};
use crate::model::DynamicsModel;
use crate::nodes::{CHUNK, NO_NODE};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// A spring is active at first if inertia leads to a gap that is less than the desired one plus this share of
/// it: bodies at rest keep their gap only up to rounding.
const ACTIVATION_MARGIN: f64 = 0.01;

/// Compliance of springs against rigid motion of bodies, in dt^2 / M. The inertia of a stiff body is far less
/// than the diagonal block of a node suggests. With springs as stiff as the block, errors of micrometers that
/// one linear solve makes in a rotation become forces of many times the weight of the body, and the updates
/// of the active set diverge.
const RIGID_COMPLIANCE: f64 = 0.3;

/// A force of friction that is smaller than its bound by more than this share sticks.
const FRICTION_BOUND_TOLERANCE: f64 = 1e-6;

/// A contact sticks if its slip is less than this share of the slip that inertia leads to.
const MAX_STICKING_SLIP: f64 = 0.1;

impl Repulsion {
    /// Sets the stiffness of the springs and guesses the active set. In the first iteration of a time step
    /// the guess is the active set at the positions `inertial`, where inertia leads; in later iterations it
    /// is the active set at the `iterate`. `diagonal` has the diagonal blocks of the Newton system without
    /// springs; `rate` is 1 / dt [1/s]. Blocks and positions have one entry per watched node, `free` one per node.
    pub fn prepare(
        &mut self,
        model: &DynamicsModel,
        diagonal: &[Matrix3<f64>],
        rate: f64,
        free: &[bool],
        inertial: &[Vector],
        iterate: Option<&[Vector]>,
    ) {
        self.guessed = true;
        self.note_lacking(free, iterate.unwrap_or(inertial));
        let softest = self.softest_stiffness(model, diagonal);
        let mut states = std::mem::take(&mut self.states);
        states.par_iter_mut().enumerate().with_min_len(CHUNK).for_each(|(spring, state)| {
            let s = &self.springs[spring];
            let mut compliance = 0.0;
            let places = self.nodes[spring].iter().zip(&self.places[spring]);
            for ((&node, &place), weight) in places.zip(s.weights) {
                if node != NO_NODE && free[node as usize] {
                    let (node, place) = (node as usize, place as usize);
                    let along = || s.normal.dot(&(diagonal[place] * s.normal));
                    let local = if model.strands[node] { softest[place] } else { along() };
                    let rigid = model.component_masses[node] * rate * rate;
                    compliance += weight * weight * (1.0 / local + RIGID_COMPLIANCE / rigid);
                }
            }
            *state = SpringState::INACTIVE;
            if compliance <= 0.0 || s.stiffness == 0.0 {
                return;
            }
            state.stiffness = s.stiffness / compliance;
            match iterate {
                None => self.guess_from_inertia(spring, state, inertial),
                Some(iterate) => self.guess_from_iterate(spring, state, inertial, iterate),
            }
            state.lambda = if state.active { self.known_multipliers(spring).0 } else { 0.0 };
        });
        self.states = states;
    }

    /// The known multipliers lambda and tau [N].
    fn known_multipliers(&self, spring: usize) -> (f64, Vector) {
        let s = &self.springs[spring];
        (s.normal.dot(&s.force).max(0.0), s.force - s.normal * s.normal.dot(&s.force))
    }

    fn guess_from_inertia(&self, spring: usize, state: &mut SpringState, inertial: &[Vector]) {
        let s = &self.springs[spring];
        let (lambda, tau) = self.known_multipliers(spring);
        let (depth, slip) = self.depth_and_slip(spring, inertial);
        // A contact that inertia opens is inactive, even if it carried a force; an upper limit of a distance
        // is active as long as it carries one.
        state.active = depth > -ACTIVATION_MARGIN * s.desired.max(0.0) || s.desired < 0.0 && lambda > 0.0;
        let length = slip.norm();
        if state.active && s.friction > 0.0 {
            // Coulomb's law for the vertices on their own: a contact sticks if friction could hold its
            // vertices, or if it carries a force and friction stays below its bound where inertia leads.
            let bound = s.friction * (lambda + state.stiffness * depth.max(0.0));
            let holds = lambda > 0.0 && (tau - slip * state.stiffness).norm() < bound;
            state.friction = if holds || length <= s.friction * depth {
                Friction::Stick(tau)
            } else {
                let bound = s.friction * lambda;
                Friction::Slide(slip / length, bound, (bound / length).min(state.stiffness))
            };
        }
    }

    fn guess_from_iterate(
        &self,
        spring: usize,
        state: &mut SpringState,
        inertial: &[Vector],
        iterate: &[Vector],
    ) {
        let s = &self.springs[spring];
        let (lambda, tau) = self.known_multipliers(spring);
        let (depth, slip) = self.depth_and_slip(spring, iterate);
        state.active = lambda > 0.0 || depth > 0.0;
        if state.active {
            let (bound, length) = (s.friction * lambda, slip.norm());
            let free_slip = self.depth_and_slip(spring, inertial).1.norm();
            let sticks = tau.norm() < (1.0 - FRICTION_BOUND_TOLERANCE) * bound
                && length < MAX_STICKING_SLIP * free_slip;
            state.friction = if sticks {
                Friction::Stick(tau)
            } else if bound > 0.0 && length > 0.0 {
                Friction::Slide(slip / length, bound, (bound / length).min(state.stiffness))
            } else {
                Friction::None
            };
        }
    }

    /// Stiffness of each watched node in its softest direction if it belongs to strands, 0 otherwise [N/m]. A bent strand resists along both of its edges, but only as long as the neighbors do not move.
    /// Springs as stiff as that are too stiff for it, and the updates of the active set diverge where strands
    /// cross.
    fn softest_stiffness(&self, model: &DynamicsModel, diagonal: &[Matrix3<f64>]) -> Vec<f64> {
        let of_node = |(&node, block): (&u32, &Matrix3<f64>)| {
            if model.strands[node as usize] { block.symmetric_eigenvalues().min() } else { 0.0 }
        };
        self.watched().par_iter().zip(diagonal).with_min_len(CHUNK).map(of_node).collect()
    }
}
