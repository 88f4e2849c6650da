//! The sequence of Newton iterations with contacts: an active-set method around [`super::iteration`].

use super::bodies::Answer;
use super::corrections::MIN_REDUCTION_RATIO;
use super::iteration::Accuracy;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;

/// Share of the contact forces that may be wrong: those of springs that pull or are missing, and errors of
/// friction.
const ACTIVE_SET_TOLERANCE: f64 = 0.002;

/// Number of Newton iterations for which [`ACTIVE_SET_TOLERANCE`] applies. In a pile of cloth thousands of
/// contacts open and close, and wrong ones are found after the collision stage. But an error of 1 % in
/// friction changes the sliding of bodies by 5 % if friction nearly holds them.
const MAX_ACTIVE_SET_UPDATES: usize = 6;

/// Share of the contact forces that may be wrong after that, and the largest number of iterations in all.
const LOOSE_ACTIVE_SET_TOLERANCE: f64 = 0.3;
const MAX_LOOSE_ACTIVE_SET_UPDATES: usize = 8;

/// Largest number of further Newton iterations while springs that pull add energy. One was enough in all
/// observed cases.
const MAX_ENERGY_UPDATES: usize = 4;

/// Energy that contacts may add, as a share of the terms of the potential: multipliers lag behind their
/// correct values.
const ENERGY_GAIN_TOLERANCE: f64 = 1e-3;

/// Largest number of Newton iterations with contacts that only push.
const MAX_ONE_SIDED_ITERATIONS: usize = 6;

impl Newton<'_> {
    /// Computes the target with springs. The first active set is a guess. Iterations update it by the result
    /// of each solve, and only then corrections follow. The guess is the active set where inertia leads; in a
    /// pile that falls half of it is wrong, and corrections with a wrong active set would be useless.
    ///
    /// A spring that wrongly pulls adds energy. The following bound limits that: the potential without
    /// springs must not end above its value at the start of the time step by more than compressed springs had
    /// stored (a target of implicit Euler keeps elastic and kinetic energy below those before). If it does,
    /// the active set is updated further, which nearly always suffices after one iteration. Otherwise the
    /// target is computed again with springs that can only push.
    pub(super) fn solve_with_contacts(&mut self) -> Answer<NewtonInfo> {
        self.place(0.0)?;
        let placed = self.bodies.trial();
        let tolerance = ENERGY_GAIN_TOLERANCE * (self.energies.kinetic.abs() + self.energies.internal.abs());
        let max_potential = *self.course.max_potential.get_or_insert(self.energies.total() + tolerance);

        let accuracy = if self.is_first { Accuracy::Full } else { Accuracy::Inexact };
        let first = self.iterate(accuracy)?;
        let (mut info, mut last) = (first, first);
        for iteration in 0..MAX_LOOSE_ACTIVE_SET_UPDATES {
            let tolerated = if iteration < MAX_ACTIVE_SET_UPDATES {
                ACTIVE_SET_TOLERANCE
            } else {
                LOOSE_ACTIVE_SET_TOLERANCE
            };
            if self.repulsion.update_active_set(&self.bodies.trial()) <= tolerated {
                break;
            }
            self.bodies.start_from_trial()?;
            last = self.iterate(Accuracy::Inexact)?;
            info.add(&last);
        }
        if self.model.has_strands() || last.reduction_ratio < MIN_REDUCTION_RATIO {
            self.correct(first.decrease(), &mut info)?;
        }
        self.refine(&mut info)?;

        let max_potential = max_potential + self.repulsion.stored_energy(&placed);
        let gains = |newton: &Self| newton.energies.total() > max_potential;
        for _ in 0..MAX_ENERGY_UPDATES {
            if !gains(self) {
                return Ok(info);
            }
            self.repulsion.update_active_set(&self.bodies.trial());
            self.bodies.start_from_trial()?;
            info.add(&self.iterate(Accuracy::Full)?);
        }
        if gains(self) {
            self.bodies.begin_again()?;
            tracing::debug!("contacts add energy: the target is computed with contacts that only push");
            self.solve_one_sided(&mut info)?;
        }
        Ok(info)
    }

    /// Computes the target with springs without multipliers: they only push, and friction resists slip from
    /// the start of the time step. The line search includes their energy, so that no energy is gained but the
    /// one that was stored.
    fn solve_one_sided(&mut self, info: &mut NewtonInfo) -> Answer<()> {
        self.repulsion.clear_multipliers(&self.bodies.iterate());
        for _ in 0..MAX_ONE_SIDED_ITERATIONS {
            let next = self.iterate(Accuracy::Full)?;
            info.add(&next);
            if !self.repulsion.update_active_set_without_multipliers(&self.bodies.trial()) {
                break;
            }
            self.bodies.start_from_trial()?;
        }
        Ok(())
    }
}
