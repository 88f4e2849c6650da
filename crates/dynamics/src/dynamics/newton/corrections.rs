//! Newton iterations that correct an inaccurate step.

use super::bodies::Answer;
use super::iteration::Accuracy;
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;

/// Reduction ratio at which a Newton step counts as accurate: the actual decrease of the potential over the
/// predicted one. At this ratio the error of the quadratic model is about a tenth of the decrease, and after
/// another iteration about the square of that.
pub(super) const MIN_REDUCTION_RATIO: f64 = 0.9;

/// Decrease of a correction below which no other one is made, as a share of the potential.
const MIN_RELATIVE_DECREASE: f64 = 1e-6;

/// Largest error of the quadratic model in the last correction, as a share of the decrease of the whole
/// target.
const MAX_MODEL_ERROR: f64 = 0.01;

/// Largest displacement of the last correction, as a share of the whole displacement.
const MAX_LAST_DISPLACEMENT: f64 = 0.2;

impl Newton<'_> {
    /// Makes Newton iterations until the quadratic model is accurate. `info` describes the iterations so far,
    /// of which the first lowered the potential by `gained` [J].
    ///
    /// Where the quadratic model is inaccurate, its minimum is far from that of the potential: without
    /// corrections stiff bodies that rotate lose most of their motion. An accurate step after an inaccurate
    /// one may only have restored lengths. The decrease of energy by the rotation of a straw is small
    /// compared with the decrease by restored lengths, so the reduction ratio does not show it. With strands
    /// the decision therefore depends on the next step.
    ///
    /// A step that the line search would shorten is first tried at full length, whatever its potential: the
    /// watchdog technique (Chamberlain, Powell, Lemarechal and Pedersen 1982). A stiff rod that rotates is
    /// stretched along its straight step. A line search would stop it there for good, while the next step
    /// restores its length.
    pub(super) fn correct(&mut self, mut gained: f64, info: &mut NewtonInfo) -> Answer<()> {
        let strands = self.model.has_strands();
        let mut finished = false;
        while !finished && info.iterations <= self.params.newton.correcting_iterations {
            let mut before = (info.step_length < 1.0).then_some(info.energy_after);
            if before.is_some() {
                self.bodies.keep_trial()?;
                let (energy, _) = self.place(1.0)?;
                if self.is_defined(energy) {
                    self.bodies.start_from_trial()?;
                } else {
                    self.bodies.start_from_kept_trial()?;
                    before = None;
                }
            } else {
                self.bodies.start_from_trial()?;
            }
            let mut next = self.iterate(Accuracy::Inexact)?;
            if before.is_some_and(|before| next.energy_after >= before) {
                self.bodies.start_from_kept_trial()?;
                info.add(&next);
                next = self.iterate(Accuracy::Inexact)?;
            }
            info.add(&next);
            let moved = self.bodies.distance_from_start();
            let small = next.max_displacement <= MAX_LAST_DISPLACEMENT * moved;
            gained += next.decrease();
            let missed = (1.0 - next.reduction_ratio) * next.decrease();
            let accurate =
                next.reduction_ratio >= MIN_REDUCTION_RATIO || !strands && missed <= MAX_MODEL_ERROR * gained;
            let stalled = next.decrease() <= MIN_RELATIVE_DECREASE * next.energy_before.abs();
            finished = small && accurate || stalled;
        }
        Ok(())
    }

    /// Makes one more iteration with an accurate solve if the last solve was inexact.
    pub(super) fn refine(&mut self, info: &mut NewtonInfo) -> Answer<()> {
        if info.cg.residual > self.params.newton.cg_tolerance {
            self.repulsion.update(&self.bodies.trial());
            self.bodies.start_from_trial()?;
            info.add(&self.iterate(Accuracy::Full)?);
        }
        Ok(())
    }
}
