//! Updates of the active set and of the multipliers after a solve.

use super::springs::Repulsion;
use super::state::{Friction, SpringState};
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;

/// Largest relative change of a bound of friction that does not count as a change of the active set.
const FRICTION_CHANGE_TOLERANCE: f64 = 0.1;

/// What an update finds at a spring [N].
#[derive(Clone, Copy, Debug, Default)]
struct Change {
    /// The correct normal force.
    right: f64,
    /// Forces that were wrong: of a spring that became active or inactive, and of friction.
    wrong: [f64; 2],
}

impl Repulsion {
    /// Updates the active set and the multipliers with watched nodes at `x`: springs that pull become inactive,
    /// springs with too small a gap become active, friction is bounded by mu times the normal force. Returns
    /// the sum of the forces that were wrong as a share of the sum of the correct normal forces.
    pub fn update_active_set(&mut self, x: &[Vector]) -> f64 {
        let guessed = std::mem::replace(&mut self.guessed, false);
        let mut states = std::mem::take(&mut self.states);
        let of_springs = states.par_iter_mut().enumerate().with_min_len(CHUNK);
        let changes: Vec<Change> =
            of_springs.map(|(spring, state)| self.update_spring(spring, state, guessed, x)).collect();
        self.states = states;
        // In order: the same bits for any number of threads.
        let right: f64 = changes.iter().map(|change| change.right).sum();
        let wrong: f64 = changes.iter().flat_map(|change| change.wrong).sum();
        if wrong > 0.0 { wrong / right.max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    /// Updates the state of a spring; the active set that the last solve had may be a guess.
    fn update_spring(&self, spring: usize, state: &mut SpringState, guessed: bool, x: &[Vector]) -> Change {
        let before = *state;
        let mut change = Change::default();
        if before.stiffness == 0.0 {
            return change;
        }
        let (depth, slip) = self.depth_and_slip(spring, x);
        let trial = before.lambda + before.stiffness * depth;
        state.active = trial > 0.0;
        if !(state.active || before.active) {
            return change;
        }
        change.right = trial.max(0.0);
        state.friction_bound = self.springs[spring].friction * change.right;
        if state.active != before.active {
            change.wrong[0] = trial.abs();
        }
        let friction = before.coulomb(before.tau(), &slip, state.friction_bound);
        state.friction = match (friction, before.friction) {
            (Friction::Stick(_), _) => Friction::Stick(before.tau()),
            // A contact whose slip reversed its direction must have stopped in between.
            (Friction::Slide(d, ..), Friction::Slide(old, ..)) if d.dot(&old) < 0.0 => {
                Friction::Stick(Vector::zeros())
            }
            _ => friction,
        };
        let correct = SpringState { friction, ..before }.tau();
        let acted = match before.friction {
            _ if !before.active => Vector::zeros(),
            Friction::None => Vector::zeros(),
            Friction::Stick(tau) if guessed => tau - slip * before.stiffness,
            Friction::Slide(direction, bound, curvature) if guessed => {
                -direction * bound - (slip - direction * direction.dot(&slip)) * curvature
            }
            _ => {
                let trial = before.tau() - slip * before.stiffness;
                trial * (before.friction_bound / trial.norm()).min(1.0)
            }
        };
        change.wrong[1] = (correct - acted).norm();
        change
    }

    /// Sets all multipliers to zero until springs are set again. Springs then store energy only by depth, and
    /// friction resists slip only. The active springs are those with a positive depth with watched nodes at `x`.
    pub fn clear_multipliers(&mut self, x: &[Vector]) {
        for state in &mut self.states {
            *state = SpringState { stiffness: state.stiffness, ..SpringState::INACTIVE };
        }
        self.update_active_set_without_multipliers(x);
    }

    /// Updates the active set with watched nodes at `x` and multipliers of zero. Returns whether a spring became
    /// active or inactive, or a bound of friction changed by much.
    pub fn update_active_set_without_multipliers(&mut self, x: &[Vector]) -> bool {
        self.guessed = false;
        let mut changed = false;
        for spring in 0..self.springs.len() {
            let mut state = self.states[spring];
            let (depth, slip) = self.depth_and_slip(spring, x);
            let active = state.stiffness > 0.0 && depth > 0.0;
            changed |= std::mem::replace(&mut state.active, active) != active;
            let bound = self.springs[spring].friction * state.stiffness * depth.max(0.0);
            changed |= (bound - state.friction_bound).abs() > FRICTION_CHANGE_TOLERANCE * bound;
            state.friction_bound = bound;
            state.friction = match state.coulomb(Vector::zeros(), &slip, state.friction_bound) {
                Friction::None => Friction::None,
                _ => Friction::Stick(Vector::zeros()),
            };
            self.states[spring] = state;
        }
        changed
    }
}
