//! Backtracking along a Newton step.

use super::bodies::{Answer, BodyEnergies, Promise};
use super::state::Newton;
use crate::dynamics::info::NewtonInfo;

/// Energies that differ by less than this share of their terms count as equal: the rounding error of sums
/// over 10^5 nodes, with a margin.
const ENERGY_ROUNDING: f64 = 1e-12;

/// Share of the bound of rounding that differences of energies are likely to be off on a device: a decrease
/// above it tells how accurate the quadratic model is.
const LIKELY_ROUNDING: f64 = 1.0 / 16.0;

impl Newton<'_> {
    /// Shortens the full Newton step until the potential decreases enough; the result is the trial. Steps
    /// that are rounding errors are accepted, as energies would differ by rounding only.
    ///
    /// Prescribed nodes are at their keyframes in all trials: the line is over free nodes only and starts
    /// from the state with free nodes at x. The predicted decrease p.b is that of the quadratic model from
    /// there. If no trial passes (the keyframes jump far, so that the model is inaccurate), the trial with
    /// the lowest potential is taken; if all of them raise it, the free nodes stay at x. Where a step is 10^6
    /// times too long, even the shortest trial would raise the potential by orders of magnitude, and that of
    /// the next iteration still more, until numbers overflow.
    pub fn search_line(&mut self, info: &mut NewtonInfo) -> Answer<()> {
        let energies = self.bodies.begin_search()?;
        let (before, scale) = self.potential(energies);
        info.energy_before = before;
        let Promise { predicted, is_negligible } = self.bodies.promise();
        let halvings = self.params.newton.line_search_halvings;
        let accept = halvings == 0 || is_negligible;
        let mut best = (before, 0.0);
        let mut length = 1.0;
        for halving in 0..=halvings {
            let (energy, terms) = self.place(length)?;
            if energy < best.0 {
                best = (energy, length);
            }
            let rounding = self.energies.rounding;
            let noise = ENERGY_ROUNDING * scale.max(terms) + LIKELY_ROUNDING * rounding;
            let slack = noise.max(rounding);
            // The slack is infinite, too, where the energy is.
            let passes = self.is_defined(energy)
                && energy <= before - self.params.newton.line_search_decrease * length * predicted + slack;
            if passes || accept {
                (info.energy_after, info.step_length) = (energy, length);
                let model = predicted * length * (1.0 - 0.5 * length);
                let kept = (before - energy) / model;
                info.reduction_ratio =
                    if accept || model <= noise { 1.0 } else { length.min(kept).min(1.0 / kept) };
                return Ok(());
            }
            if halving < halvings {
                length *= 0.5;
            }
        }
        (info.energy_after, info.step_length) = best;
        self.place(best.1)?;
        tracing::debug!(step_length = best.1, "no trial of the line search decreased the energy enough");
        Ok(())
    }

    /// Whether all custom elements are defined at a trial of this `energy` [J]. Without them only an overflow is
    /// infinite, and the target that it leads to is refused.
    pub fn is_defined(&self, energy: f64) -> bool {
        energy.is_finite() || self.model.custom.is_none()
    }

    /// Places the trial. Returns the potential there with springs, and the sum of the sizes of its parts, to
    /// which rounding is relative [J].
    pub fn place(&mut self, length: f64) -> Answer<(f64, f64)> {
        let energies = self.bodies.place(length)?;
        Ok(self.potential(energies))
    }

    /// The potential at the trial and the sum of the sizes of its parts, from that of the bodies.
    fn potential(&mut self, energies: BodyEnergies) -> (f64, f64) {
        self.energies = energies;
        let internal = self.energies.internal + self.repulsion.energy(&self.bodies.trial());
        let kinetic = self.energies.kinetic;
        (kinetic + internal, kinetic.abs() + internal.abs())
    }
}
