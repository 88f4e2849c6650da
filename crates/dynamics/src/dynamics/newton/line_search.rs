//! Backtracking along a Newton step.

use super::state::Newton;
use crate::dynamics::info::NewtonInfo;
use crate::linear::vectors::dot;
use bowknot_geometry::Vector;

/// Energies that differ by less than this share of their terms count as equal: the rounding error of sums
/// over 10^5 nodes, with a margin.
const ENERGY_ROUNDING: f64 = 1e-12;

/// Steps shorter than this share of the largest coordinate are rounding errors. They are accepted without a
/// line search, as energies would differ by rounding only.
const NEGLIGIBLE_STEP: f64 = 1e-12;

impl Newton<'_> {
    /// Shortens the full Newton step until the potential decreases enough; the result is in `work.trial`.
    ///
    /// Prescribed nodes are at their keyframes in all trials: the line is over free nodes only and starts
    /// from the state with free nodes at x. The predicted decrease p.b is that of the quadratic model from
    /// there. If no trial passes (the keyframes jump far, so that the model is inaccurate), the trial with
    /// the lowest potential is taken; if all of them raise it, the free nodes stay at x. Where a step is 10^6
    /// times too long, even the shortest trial would raise the potential by orders of magnitude, and that of
    /// the next iteration still more, until numbers overflow.
    pub fn search_line(&mut self, info: &mut NewtonInfo) {
        self.work.place(0.0);
        let (before, scale) = self.at_trial(Self::potential);
        info.energy_before = before;
        let predicted = dot(&self.work.step, &self.work.right_side);
        // A maximum is the same in any order.
        let largest = |values: &[Vector]| values.iter().map(|v| v.amax()).fold(0.0, f64::max);
        let halvings = self.params.newton.line_search_halvings;
        let accept = halvings == 0 || largest(&self.work.step) <= NEGLIGIBLE_STEP * largest(&self.work.x);
        let mut best = (before, 0.0);
        let mut length = 1.0;
        for halving in 0..=halvings {
            self.work.place(length);
            let (energy, terms) = self.at_trial(Self::potential);
            if energy < best.0 {
                best = (energy, length);
            }
            let slack = ENERGY_ROUNDING * scale.max(terms);
            let passes =
                energy <= before - self.params.newton.line_search_decrease * length * predicted + slack;
            if passes || accept {
                (info.energy_after, info.step_length) = (energy, length);
                let model = predicted * length * (1.0 - 0.5 * length);
                let kept = (before - energy) / model;
                info.reduction_ratio =
                    if accept || model <= slack { 1.0 } else { length.min(kept).min(1.0 / kept) };
                return;
            }
            if halving < halvings {
                length *= 0.5;
            }
        }
        (info.energy_after, info.step_length) = best;
        self.work.place(best.1);
        tracing::debug!(step_length = best.1, "no trial of the line search decreased the energy enough");
    }
}
