//! What pairs carry at the start of a call.

use super::buffers::{Buffers, words};
use crate::engine::Engine;
use crate::error::GpuError;
use crate::grid::Grid;
use crate::kernels;
use crate::layout::{Candidate, CarriedState};
use crate::recording::{BufferId, Recording};
use bowknot_geometry::Vector;

/// What a pair carries at the start of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// The pair. Where both sides are of one kind, their order is that of `friction` alone.
    pub candidate: Candidate,
    /// Multiplier of its contact row [m, in units of the mean mass].
    pub multiplier: f64,
    /// Multiplier of friction on side *a*, in the same units.
    pub friction: Vector,
}

/// Entries in the order of the search in `warm_start.wgsl`. Those that do not press, or have no finite
/// numbers in single precision, are left out, and all but the first of a pair.
pub fn sorted(grid: &Grid, carried: &[Carried]) -> Vec<CarriedState> {
    let entry = |pair: &Carried| {
        let candidate = pair.candidate.ordered();
        let sign = if candidate == pair.candidate { 1.0 } else { -1.0 };
        let friction = [0, 1, 2].map(|k| grid.length(sign * pair.friction[k]));
        CarriedState {
            friction,
            multiplier: grid.length(pair.multiplier),
            candidate,
            padding_0: 0,
            padding_1: 0,
        }
    };
    let is_finite = |entry: &CarriedState| {
        entry.multiplier.is_finite() && entry.friction.iter().all(|component| component.is_finite())
    };
    let entries = carried.iter().map(entry).filter(|entry| entry.multiplier > 0.0 && is_finite(entry));
    let mut entries: Vec<CarriedState> = entries.collect();
    entries.sort_by_key(|entry| entry.candidate);
    entries.dedup_by_key(|entry| entry.candidate);
    entries
}

/// The list, on an engine. It has no room before the first call with entries.
#[derive(Clone, Copy, Debug)]
pub struct CarriedList {
    buffer: BufferId,
    /// Entries for which there is room.
    capacity: usize,
    /// Those of the call.
    count: usize,
}

impl CarriedList {
    pub fn new(engine: &mut impl Engine) -> Result<Self, GpuError> {
        Self::with_room(engine, 0)
    }

    /// Takes the entries of a call. Room grows by a quarter more than is needed.
    ///
    /// # Errors
    /// The device has no memory.
    pub fn set(
        &mut self,
        engine: &mut impl Engine,
        entries: &[CarriedState],
        recording: &mut Recording,
    ) -> Result<(), GpuError> {
        if self.capacity < entries.len() {
            // A call that began and made no step has left its entries in the recording.
            recording.forget(self.buffer);
            engine.free(self.buffer);
            *self = Self::with_room(engine, entries.len() + entries.len() / 4)?;
        }
        self.count = entries.len();
        if !entries.is_empty() {
            recording.write(self.buffer, entries);
        }
        Ok(())
    }

    fn with_room(engine: &mut impl Engine, capacity: usize) -> Result<Self, GpuError> {
        let buffer = engine.buffer("carried multipliers", words::<CarriedState>(capacity))?;
        Ok(Self { buffer, capacity, count: 0 })
    }

    /// Gives new candidates what their pairs carry, if any does. [`kernels::DESIRED_DISTANCES`] keeps it when
    /// it completes their states.
    pub fn record(&self, b: &Buffers, recording: &mut Recording) {
        if self.count == 0 {
            return;
        }
        recording.dispatch(
            &kernels::WARM_START,
            &[self.buffer, b.candidates, b.states, b.control],
            kernels::warm_start::Params { capacity: b.capacity as u32, carried: self.count as u32 },
            b.capacity,
        );
    }
}
