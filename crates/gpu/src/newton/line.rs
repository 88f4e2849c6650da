//! Trials of the line search.

use super::layout::{SUMMARY, SUMS};
use super::places::{Newton, bits};
use super::search::Search;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::kernels;
use crate::linear::{MOST_WORKGROUPS, THREADS};
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{Trial, Watched};
use std::mem::take;

/// Largest coordinate of the grid, as a number: see `trial_positions.wgsl`.
const REACH: f64 = ((1u32 << 29) - 1) as f64;

/// Bits by which the grid may get coarser for a trial. A trial that would need more is 16 times as far as the
/// state is large: it ends at the border of the grid, where the line search refuses it, and shorter ones keep
/// their digits.
const MOST_BITS: u32 = 4;

/// Most nodes whose trials are read as a whole each time: a target then takes no wait of its own.
const MOST_READ: usize = 1 << 14;

impl Newton {
    /// Workgroups of the stages that sum over all nodes.
    pub fn workgroups(&self) -> usize {
        self.nodes.div_ceil(THREADS).clamp(1, MOST_WORKGROUPS)
    }

    /// Records the iterate plus that length of the step, which goes to `trial`.
    pub fn record_trial_positions(&self, length: f64, trial: BufferId, recording: &mut Recording) {
        let (v, workgroups) = (&self.vectors, self.workgroups());
        recording.dispatch(
            &kernels::TRIAL_POSITIONS,
            &[v.iterate, v.imposed, v.free, v.step, v.right_side, v.target_start, trial, v.sums],
            kernels::trial_positions::Params {
                nodes: self.nodes as u32,
                workgroups: workgroups as u32,
                imposed: u32::from(self.imposes),
                scale: (length / self.grid.quantum) as f32,
            },
            THREADS * workgroups,
        );
    }

    /// Records the reference, and the trial at full length with its energies. Returns what to read.
    pub fn record_search(&self, recording: &mut Recording) -> Vec<(BufferId, usize)> {
        let v = &self.vectors;
        self.record_trial_positions(0.0, v.reference, recording);
        let seen = self.record_watched(v.reference, 4, v.seen_at_reference, recording);
        [vec![seen], self.record_trial(1.0, recording)].concat()
    }

    /// A search from what was read of it; None if the grid is too small for it.
    pub fn search(&self, read: &mut [Vec<u32>]) -> Option<Search> {
        let summary = Summary::new(&read[1]);
        (summary.missing_bits() == 0).then(|| Search {
            at_reference: self.positions(&read[0]).collect(),
            trial: self.trial(&summary, &read[2], &read[3]),
            words: read.get_mut(4).map(take),
        })
    }

    /// Makes the reference, and the trial at full length with its energies, in one submission if the solve
    /// has not made them. Returns the watched nodes at the reference too.
    pub fn begin_search<E: Engine>(&mut self, engine: &mut E) -> Result<(Watched, Trial), GpuError> {
        if self.is_solved {
            let found = match self.searched.take() {
                Some(found) => Some(found),
                None => {
                    let mut recording = take(&mut self.pending);
                    let read = self.record_search(&mut recording);
                    self.search(&mut engine.run(&recording, &read)?)
                }
            };
            if let Some(Search { at_reference, trial, words }) = found {
                self.trial_words = words;
                return Ok((at_reference, trial));
            }
        }
        let reference = self.make_trial(engine, 0.0)?;
        Ok((reference.watched, self.make_trial(engine, 1.0)?))
    }

    /// Records a trial with its energies. Returns what to read: a [`Summary`], energies, watched nodes, and
    /// of a small model the trial.
    fn record_trial(&self, length: f64, recording: &mut Recording) -> Vec<(BufferId, usize)> {
        let v = &self.vectors;
        self.record_trial_positions(length, v.trial, recording);
        let count = self.workgroups() as u32;
        recording.dispatch(
            &kernels::REDUCE_TRIAL,
            &[v.sums, v.summary],
            kernels::reduce_trial::Params { count },
            1,
        );
        if length == 0.0 {
            self.record_copy(v.trial, v.reference, recording);
        }
        let quantum = self.grid.quantum as f32;
        self.potential.record_energies(v.reference, v.trial, v.start, quantum, recording);
        let watched = self.record_watched(v.trial, 4, v.seen, recording);
        let mut read = vec![(v.summary, SUMS), self.potential.energy_words(), watched];
        if self.nodes <= MOST_READ {
            read.push((v.trial, 4 * self.nodes));
        }
        read
    }

    /// Makes a trial with its energies.
    pub fn make_trial<E: Engine>(&mut self, engine: &mut E, length: f64) -> Result<Trial, GpuError> {
        // There is no step before a solve.
        let length = if self.is_solved { length } else { 0.0 };
        let mut recording = take(&mut self.pending);
        let mut is_coarsened = false;
        self.change_trial();
        loop {
            let wanted = self.record_trial(length, &mut recording);
            let mut read = engine.run(&recording, &wanted)?;
            let summary = Summary::new(&read[0]);
            let needed = summary.missing_bits();
            if needed > 0 && needed <= MOST_BITS && !is_coarsened {
                recording = Recording::default();
                self.coarsen(needed, &mut recording);
                is_coarsened = true;
                continue;
            }
            self.trial_words = read.get_mut(3).map(take);
            return Ok(self.trial(&summary, &read[1], &read[2]));
        }
    }

    /// A trial from what was read of it.
    fn trial(&self, summary: &Summary, energies: &[u32], watched: &[u32]) -> Trial {
        let energies = self.potential.energies(energies);
        let quantum = self.grid.quantum;
        Trial {
            reference: energies.reference,
            change: energies.change,
            rounding: energies.rounding,
            predicted: if self.is_solved { summary.product } else { 0.0 },
            largest_step: if self.is_solved { summary.largest } else { 0.0 },
            from_iterate: summary.from_iterate.sqrt() * quantum,
            from_start: summary.from_start.sqrt() * quantum,
            watched: self.positions(watched).collect(),
        }
    }
}

/// What `reduce_trial` finds: p . b, and what is largest of the components of p [m], of the squared distances
/// from the iterate and from the start of the target [quanta^2], and of the coordinates.
struct Summary {
    product: f64,
    largest: f64,
    from_iterate: f64,
    from_start: f64,
    coordinate: f64,
}

impl Summary {
    fn new(words: &[u32]) -> Self {
        let mut numbers = [0.0; SUMMARY];
        numbers.iter_mut().zip(words).for_each(|(s, bits)| *s = f64::from(f32::from_bits(*bits)));
        let [product, largest, from_iterate, from_start, coordinate] = numbers;
        Self { product, largest, from_iterate, from_start, coordinate }
    }

    /// By how many bits the grid is too small. A coordinate that is not finite is farther than any state.
    fn missing_bits(&self) -> u32 {
        bits(self.coordinate / REACH)
    }
}
