//! The sequence of Newton iterations with contacts, around [`super::iteration`].

use super::bodies::Answer;
use super::iteration::Accuracy;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;

/// Share of the contact forces by which a Newton step may have been off. Larger: fewer iterations, but an
/// error of 1 % in friction changes the sliding of bodies by 5 % if friction nearly holds them. Smaller: more
/// iterations.
const FORCE_TOLERANCE: f64 = 0.002;

/// Share of the contact forces by which it may have been off in a target that another one follows, where iterations
/// gain little. Larger: fewer iterations in a target, more targets. Smaller: targets that the collision stage
/// changes in any case are solved too well.
const ROUGH_FORCE_TOLERANCE: f64 = 0.5;

/// Factor on that share by which an iteration gains little: thousands of contacts open and close then. Larger:
/// more iterations in piles of cloth. Smaller: rough targets are rougher.
const GAIN: f64 = 0.1;

/// Largest number of Newton iterations after the first. More: targets with many contacts cost more. Fewer:
/// what is wrong is found after the collision stage, in the next target.
const MAX_ITERATIONS: usize = 12;

/// Share of the last Newton step that the line search must have kept. Larger: more iterations where friction
/// changes from sticking to sliding. Smaller: targets may end where a step was cut short.
const MIN_STEP_LENGTH: f64 = 0.9;

impl Newton<'_> {
    /// Computes the target with springs: makes Newton iterations until the forces that the linear system gave
    /// to the contacts are those that the contacts have, or nearly so and iterations gain little, then
    /// corrections. The last system is solved accurately unless another target is likely to follow.
    pub(super) fn solve_with_contacts(&mut self) -> Answer<NewtonInfo> {
        let accuracy = if self.is_first { Accuracy::Full } else { Accuracy::Inexact };
        let first = self.iterate(accuracy)?;
        let (mut info, mut last, mut last_wrong) = (first, first, f64::INFINITY);
        let mut is_rough = false;
        for _ in 0..MAX_ITERATIONS {
            let wrong = self.repulsion.update(&self.bodies.trial());
            let is_full_step = last.step_length > MIN_STEP_LENGTH;
            if wrong <= FORCE_TOLERANCE && is_full_step {
                break;
            }
            is_rough = self.course.is_far()
                && is_full_step
                && wrong <= ROUGH_FORCE_TOLERANCE
                && wrong > GAIN * last_wrong;
            if is_rough {
                break;
            }
            last_wrong = wrong;
            self.bodies.start_from_trial()?;
            last = self.iterate(Accuracy::Inexact)?;
            info.add(&last);
        }
        if self.model.has_strands() || !self.is_accurate(&last) {
            self.correct(first.decrease(), &mut info)?;
        }
        if !self.course.is_far() {
            self.refine(&mut info)?;
        }
        info.is_rough = is_rough;
        Ok(info)
    }
}
