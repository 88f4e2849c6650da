//! Submissions of steps, and what they came to.

use super::buffers::{most_candidates, words};
use super::{Collision, CollisionError, Settings, StepReport};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::layout::Control;
use crate::recording::Recording;
use std::mem::take;

/// Smallest factor on travel and trust regions. Candidates are then little more than the pairs within contact
/// range, and steps are still longer than the moves that count as progress when a call may have stalled.
const SMALLEST_TRAVEL: f32 = 1.0 / 64.0;

/// So many contact rows, and a quarter, are read more than the last call had.
const MORE_ROWS: usize = 16;

impl Settings {
    /// Whether steps can polish.
    pub(super) fn has_polishing(&self) -> bool {
        self.polish_sweeps > self.sweeps
    }

    /// Sweeps of a step that polishes after so many of the call that did. Most edges need few; in large
    /// bodies that hang on a few vertices no number of sweeps within clusters takes the place of many over
    /// all.
    pub(super) fn sweeps_to_polish(&self, polished: usize) -> usize {
        let doubled = 1usize.checked_shl(polished as u32).and_then(|factor| self.sweeps.checked_mul(factor));
        doubled.map_or(self.polish_sweeps, |sweeps| sweeps.min(self.polish_sweeps))
    }

    /// Whether the step after this one polishes.
    pub(super) fn polishes_after(&self, report: &StepReport) -> bool {
        let is_near = report.remaining < self.polish_distance;
        self.has_polishing() && is_near && report.stretch_to_limit > self.polish_stretch
    }
}

impl<E: Engine> Collision<E> {
    /// Moves the vertices toward their target as far as all candidate pairs allow.
    ///
    /// # Errors
    /// The device failed, or has no memory for all candidates, or does not bind those within contact range.
    pub fn step(&mut self) -> Result<StepReport, CollisionError> {
        Ok(self.steps(1)?[0])
    }

    /// Makes up to `most` steps, at least one. The host submits them together and reads what they came to
    /// once; after the end of the call ([`Call::stop`](super::Call::stop)) none is made. The states are the
    /// same bits for any `most`.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn steps(&mut self, most: usize) -> Result<Vec<StepReport>, CollisionError> {
        let mut reports = Vec::with_capacity(most);
        loop {
            // A step is made again alone, since room for the following ones is made after it.
            let left = if self.again && !self.fresh { 1 } else { most.max(1) - reports.len() };
            let control = self.submit(left.min(self.expected()), &mut reports)?;
            if control.overflow == 0 {
                return Ok(reports);
            }
        }
    }

    /// Finds the candidates at the start of a call, if no step has done so.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn search(&mut self) -> Result<(), CollisionError> {
        while self.fresh {
            self.submit(0, &mut Vec::new())?;
        }
        Ok(())
    }

    /// Number of steps that a submission is likely to make.
    fn expected(&self) -> usize {
        self.expected_steps[usize::from(self.polishes)]
    }

    /// Submits steps, after a search if the call begins. Adds the reports of those that were made, and makes
    /// room if one was not because a buffer was too small.
    fn submit(&mut self, steps: usize, reports: &mut Vec<StepReport>) -> Result<Control, CollisionError> {
        if self.fresh || !self.again {
            self.buffers.make_room_for_step(&mut self.engine)?;
        }
        self.listed = false;
        let mut recording = self.record_submission(steps)?;
        let control = (self.buffers.control, words::<Control>(1));
        let mut read = vec![control, (self.buffers.reports, words::<Control>(steps))];
        // The end of the call comes with it where the last call took no more submissions. Room was made
        // above.
        self.submissions += 1;
        let [submissions, rows] = self.before;
        let ends = steps > 0 && self.submissions >= submissions && (self.fresh || !self.again);
        let rows = (rows + rows / 4 + MORE_ROWS).min(self.buffers.row_capacity);
        if ends {
            self.record_end(&mut recording);
            read.extend(self.end_reads(rows));
        }
        let mut all = self.engine.run(&recording, &read)?;
        let control = bytemuck::cast_slice::<u32, Control>(&all[0])[0];
        let made = control.steps as usize;
        if self.polishes {
            self.polished += made;
        }
        reports.extend(bytemuck::cast_slice::<u32, Control>(&all[1])[..made].iter().map(|r| self.report(r)));
        if control.overflow == 0 {
            self.expect(made, control.halted != 0);
            self.listed = true;
        }
        if control.halted != Control::HALTED_BY_SEARCH {
            (self.fresh, self.again, self.shrunk) = (false, false, false);
        }
        if control.halted == Control::HALTED_BY_ROWS {
            self.buffers.grow_rows(&mut self.engine, &self.sizes, control.rows as usize)?;
        } else if control.overflow != 0 {
            self.make_room(&control)?;
        }
        if let Some(last) = reports.last() {
            self.polishes = self.settings.polishes_after(last);
            self.row_count = last.contact_rows;
        }
        let has_ended = ends && self.listed && self.row_count <= rows;
        self.ended = has_ended.then(|| all.split_off(2));
        Ok(control)
    }

    /// Notes how many steps a submission made, and whether it was halted then. As many steps are expected as
    /// there were before the last halt, and from there on as many as there have been.
    fn expect(&mut self, made: usize, halted: bool) {
        self.steps_in_a_row += made;
        self.expected_steps[usize::from(self.polishes)] = self.steps_in_a_row.max(1);
        if halted {
            self.steps_in_a_row = 0;
        }
    }

    /// The search of a call that begins, and steps. The device leaves out what comes after the end of the
    /// call or after a buffer that is too small.
    fn record_submission(&mut self, steps: usize) -> Result<Recording, GpuError> {
        let dispatches = steps * self.dispatches_per_step();
        self.buffers.make_room_for_steps(&mut self.engine, steps, dispatches)?;
        let arguments = self.buffers.arguments;
        let (mut recording, mut place, mut left) = (take(&mut self.pending), 0, steps);
        if self.fresh {
            self.record_first_search(dispatches, &mut recording);
        } else if steps > 0 {
            let mut first = Recording::default();
            self.record_step(true, dispatches, &mut first);
            place = recording.append_conditional(&first, arguments, place);
            left -= 1;
        }
        // Steps that polish have more sweeps from one to the next.
        let polished = self.polished;
        let mut following = None;
        for made in steps - left..steps {
            if following.is_none() || self.polishes {
                self.polished = polished + made;
                following = Some(self.recorded_step(dispatches));
            }
            if let Some(step) = &following {
                place = recording.append_conditional(step, arguments, place);
            }
        }
        self.polished = polished;
        debug_assert!(place <= dispatches);
        recording.fill_arguments(arguments);
        Ok(recording)
    }

    /// Most dispatches of a step that can be left out; a step that is made again has fewer.
    fn dispatches_per_step(&mut self) -> usize {
        let polishes = usize::from(self.polishes);
        if let Some(known) = self.step_dispatches[polishes] {
            return known;
        }
        let arguments = self.buffers.arguments;
        let polished = std::mem::replace(&mut self.polished, usize::MAX);
        let count = Recording::default().append_conditional(&self.recorded_step(0), arguments, 0);
        self.polished = polished;
        self.step_dispatches[polishes] = Some(count);
        count
    }

    /// A step that is made after others, or after a search.
    fn recorded_step(&mut self, dispatches: usize) -> Recording {
        let before = (self.fresh, self.again, self.shrunk);
        (self.fresh, self.again, self.shrunk) = (false, false, false);
        let mut recording = Recording::default();
        self.record_step(false, dispatches, &mut recording);
        (self.fresh, self.again, self.shrunk) = before;
        recording
    }

    /// Makes room for what did not fit. The step is made again with the trust regions that it has found, so
    /// that it has the same bits as if there had been room. Where the device does not bind as much, it is
    /// made with smaller ones.
    fn make_room(&mut self, control: &Control) -> Result<(), GpuError> {
        let candidates = control.candidates as usize;
        self.again = true;
        if candidates > most_candidates(&self.engine) && self.travel > SMALLEST_TRAVEL {
            (self.travel, self.shrunk) = (0.5 * self.travel, true);
            tracing::debug!(candidates, travel = self.travel, "trust regions shrank");
            return Ok(());
        }
        self.buffers.grow(&mut self.engine, candidates)
    }

    fn report(&self, control: &Control) -> StepReport {
        let length = |bits: u32| f64::from(f32::from_bits(bits)) * self.grid.quantum();
        StepReport {
            candidates: control.candidates as usize,
            searched: control.changed != 0,
            frozen: control.frozen as usize,
            remaining: length(control.remaining()),
            free_remaining: length(control.free_remaining),
            lag: length(control.lag),
            unhindered: length(control.unhindered),
            unhindered_lag: length(control.unhindered_lag),
            largest_move: length(control.largest_move),
            free_move: length(control.free_move),
            contact_rows: control.rows as usize,
            pressing: control.pressing as usize,
            net_residual: length(control.net_residual),
            mean_residual: length(control.mean_residual),
            stretch_to_limit: f64::from(f32::from_bits(control.stretch_to_limit)),
        }
    }
}
