//! The sequence of Newton iterations from a state to the target.
//!
//! In each target the last linear system is solved accurately, but not with strands whose contacts have not
//! settled, and so is the first one of a time step and of a target without contacts. The solves between are
//! inexact, as another linearization follows: an inexact Newton method (Dembo, Eisenstat and Steihaug 1982).

use super::bodies::Answer;
use super::corrections::MIN_REDUCTION_RATIO;
use super::iteration::Accuracy;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;

impl Newton<'_> {
    /// Computes the target.
    pub fn solve(&mut self) -> Answer<NewtonInfo> {
        if self.repulsion.is_empty() { self.solve_without_contacts() } else { self.solve_with_contacts() }
    }

    /// Makes a Newton iteration and, if it was inaccurate or there are strands, corrections.
    fn solve_without_contacts(&mut self) -> Answer<NewtonInfo> {
        let mut info = self.iterate(Accuracy::Full)?;
        if info.reduction_ratio < MIN_REDUCTION_RATIO || self.model.has_strands() {
            self.correct(info.decrease(), &mut info)?;
            self.refine(&mut info)?;
        }
        Ok(info)
    }
}
