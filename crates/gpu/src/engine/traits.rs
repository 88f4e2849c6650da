//! What every engine does.

use super::phases::PhaseSeconds;
use crate::error::GpuError;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::DeviceWork;

/// Words of the smallest buffer: a buffer that is bound must hold an entry of its array, whatever is in it.
pub(super) const SMALLEST_BUFFER: usize = 32;

/// Holds buffers and runs recordings. A buffer is a list of words of 32 bits.
pub trait Engine {
    /// Makes a buffer of at least `words` zeros.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`], [`GpuError::OutOfMemory`].
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError>;

    /// Frees a buffer, which must not be used any more.
    fn free(&mut self, buffer: BufferId);

    /// Frees all buffers.
    fn clear(&mut self);

    /// Number of words of a buffer.
    fn words(&self, buffer: BufferId) -> usize;

    /// Most words of a buffer: [`Self::buffer`] refuses larger ones.
    fn most_words(&self) -> usize {
        usize::MAX
    }

    /// Seconds of the phases since the last call, between time stamps of a device; None if there are none.
    fn take_phase_seconds(&mut self) -> Option<PhaseSeconds> {
        None
    }

    /// What was asked for since the engine was opened.
    fn work(&self) -> DeviceWork {
        DeviceWork::default()
    }

    /// Runs a recording, then reads the first words of some buffers.
    ///
    /// # Errors
    /// [`GpuError::Driver`], [`GpuError::Lost`].
    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError>;
}
