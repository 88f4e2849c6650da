//! The list of the pairs that may be within contact range at the end of a call.

use super::buffers::words;
use crate::engine::Engine;
use crate::error::GpuError;
use crate::layout::Candidate;
use crate::recording::BufferId;

/// Pairs for which there is room at first.
const FIRST_PAIRS: usize = 256;

/// The list, on an engine.
#[derive(Clone, Copy, Debug)]
pub struct NearList {
    pub buffer: BufferId,
    /// Pairs for which there is room.
    pub capacity: usize,
}

impl NearList {
    pub fn new(engine: &mut impl Engine) -> Result<Self, GpuError> {
        Self::with_room(engine, FIRST_PAIRS)
    }

    /// Makes room for so many pairs and a quarter more; what was there is lost.
    ///
    /// # Errors
    /// The device has no memory.
    pub fn grow(&mut self, engine: &mut impl Engine, pairs: usize) -> Result<(), GpuError> {
        engine.free(self.buffer);
        *self = Self::with_room(engine, pairs + pairs / 4)?;
        Ok(())
    }

    fn with_room(engine: &mut impl Engine, capacity: usize) -> Result<Self, GpuError> {
        Ok(Self { buffer: engine.buffer("pairs in range", words::<Candidate>(capacity))?, capacity })
    }
}
