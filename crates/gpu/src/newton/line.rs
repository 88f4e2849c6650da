//! Trials of the line search.

use super::layout::{SUMMARY, SUMS};
use super::places::{Newton, bits};
use crate::cpu;
use crate::cpu::sum::{MOST_WORKGROUPS, THREADS};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::recording::Recording;
use crate::stages;
use bowknot_dynamics::Trial;

/// Largest coordinate of the grid, as a number: see `attempt.wgsl`.
const REACH: f64 = ((1u32 << 29) - 1) as f64;

/// Bits by which the grid may get coarser for a trial. A trial that would need more is 16 times as far as the state is
/// large: it ends at the border of the grid, where the line search refuses it, and shorter ones keep their digits.
const MOST_BITS: u32 = 4;

impl Newton {
    /// Workgroups of the stages that sum over all nodes.
    pub fn workgroups(&self) -> usize {
        self.nodes.div_ceil(THREADS).clamp(1, MOST_WORKGROUPS)
    }

    /// Records a trial at that length of the step.
    pub fn record_attempt(&self, length: f64, recording: &mut Recording) {
        let (v, workgroups) = (&self.vectors, self.workgroups());
        recording.dispatch(
            &stages::ATTEMPT,
            &[v.iterate, v.imposed, v.free, v.step, v.right_side, v.target_start, v.trial, v.sums],
            cpu::attempt::Params {
                nodes: self.nodes as u32,
                workgroups: workgroups as u32,
                imposed: u32::from(self.imposes),
                scale: (length / self.grid.quantum) as f32,
            },
            THREADS * workgroups,
        );
    }

    /// Makes a trial with its energies.
    pub fn make_trial<E: Engine>(&mut self, engine: &mut E, length: f64) -> Result<Trial, GpuError> {
        // There is no step before a solve.
        let length = if self.is_solved { length } else { 0.0 };
        let mut recording = Recording::default();
        let mut is_coarsened = false;
        loop {
            self.record_attempt(length, &mut recording);
            let v = &self.vectors;
            let count = self.workgroups() as u32;
            recording.dispatch(&stages::SUMMARIZE, &[v.sums, v.summary], cpu::summarize::Params { count }, 1);
            if length == 0.0 {
                self.record_copy(v.trial, v.reference, &mut recording);
            }
            let quantum = self.grid.quantum;
            self.potential.record_energies(v.reference, v.trial, v.start, quantum as f32, &mut recording);
            let watched = self.record_watched(v.trial, 4, &mut recording);
            let read =
                engine.run(&recording, &[(v.summary, SUMS), self.potential.energy_words(), watched])?;
            let mut summary = [0.0; SUMMARY];
            summary.iter_mut().zip(&read[0]).for_each(|(s, bits)| *s = f64::from(f32::from_bits(*bits)));
            let [product, largest, from_iterate, from_start, coordinate] = summary;
            // A coordinate that is not finite is farther than any state.
            let needed = bits(coordinate / REACH);
            if needed > 0 && needed <= MOST_BITS && !is_coarsened {
                recording = Recording::default();
                self.coarsen(needed, &mut recording);
                is_coarsened = true;
                continue;
            }
            let energies = self.potential.energies(&read[1]);
            return Ok(Trial {
                reference: energies.reference,
                change: energies.change,
                rounding: energies.rounding,
                predicted: if self.is_solved { product } else { 0.0 },
                largest_step: if self.is_solved { largest } else { 0.0 },
                from_iterate: from_iterate.sqrt() * quantum,
                from_start: from_start.sqrt() * quantum,
                watched: self.positions(&read[2]).collect(),
            });
        }
    }
}
