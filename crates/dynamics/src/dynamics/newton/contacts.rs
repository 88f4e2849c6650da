//! The sequence of Newton iterations with contacts, around [`super::iteration`].

use super::bodies::Answer;
use super::corrections::MIN_REDUCTION_RATIO;
use super::iteration::Accuracy;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;

/// Share of the contact forces by which a Newton step may have been off. Larger: fewer iterations, but an
/// error of 1 % in friction changes the sliding of bodies by 5 % if friction nearly holds them. Smaller: more
/// iterations.
const FORCE_TOLERANCE: f64 = 0.002;

/// Number of Newton iterations after the first for which [`FORCE_TOLERANCE`] applies. More: piles of cloth,
/// where thousands of contacts open and close, cost more. Fewer: their contact forces are less accurate.
const STRICT_ITERATIONS: usize = 10;

/// Share of the contact forces by which a later step may have been off. Larger: the method gives up earlier.
/// Smaller: it makes all of [`MAX_ITERATIONS`] more often.
const LOOSE_FORCE_TOLERANCE: f64 = 0.3;

/// Largest number of Newton iterations after the first. More: targets with many contacts cost more. Fewer:
/// what is wrong is found after the collision stage, in the next target.
const MAX_ITERATIONS: usize = 12;

/// Share of the last Newton step that the line search must have kept. Larger: more iterations where friction
/// changes from sticking to sliding. Smaller: targets may end where a step was cut short.
const MIN_STEP_LENGTH: f64 = 0.9;

impl Newton<'_> {
    /// Computes the target with springs: makes Newton iterations until the forces that the linear system gave
    /// to the contacts are those that the contacts have, then corrections, then an accurate solve. With strands,
    /// whose accurate solves take thousands of iterations, only if contacts have settled: while they open and
    /// close, the line search keeps little of what such a solve finds.
    pub(super) fn solve_with_contacts(&mut self) -> Answer<NewtonInfo> {
        let accuracy = if self.is_first { Accuracy::Full } else { Accuracy::Inexact };
        let first = self.iterate(accuracy)?;
        let (mut info, mut last) = (first, first);
        let is_settled = self.settle_contacts(&mut info, &mut last)?;
        if self.model.has_strands() || last.reduction_ratio < MIN_REDUCTION_RATIO {
            self.correct(first.decrease(), &mut info)?;
        }
        if is_settled || !self.model.has_strands() {
            self.refine(&mut info)?;
        }
        Ok(info)
    }

    /// Makes Newton iterations after the `last` one until the contacts have the forces that the linear system gave
    /// them. Returns whether they do in the end; `info` describes all iterations.
    fn settle_contacts(&mut self, info: &mut NewtonInfo, last: &mut NewtonInfo) -> Answer<bool> {
        for iteration in 0..MAX_ITERATIONS {
            let tolerated =
                if iteration < STRICT_ITERATIONS { FORCE_TOLERANCE } else { LOOSE_FORCE_TOLERANCE };
            let wrong = self.repulsion.update(&self.bodies.trial());
            if wrong <= tolerated && last.step_length > MIN_STEP_LENGTH {
                return Ok(true);
            }
            self.bodies.start_from_trial()?;
            *last = self.iterate(Accuracy::Inexact)?;
            info.add(last);
        }
        Ok(false)
    }
}
