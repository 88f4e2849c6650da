//! Runs recordings with the twins of the kernels, on one thread.

use super::traits::{Engine, SMALLEST_BUFFER};
use crate::bound::Bound;
use crate::error::GpuError;
use crate::layout::NONE;
use crate::recording::{BufferId, Command, Dispatch, Recording};
use bowknot_dynamics::DeviceWork;
use std::cell::{Ref, RefCell};

/// Buffers in the memory of the host.
#[derive(Debug, Default)]
pub struct TwinEngine {
    buffers: Vec<RefCell<Vec<u32>>>,
    /// Size of the largest buffer [bytes], if there is a limit.
    largest_buffer: Option<u64>,
    work: DeviceWork,
}

impl TwinEngine {
    /// Without buffers.
    pub fn new() -> Self {
        Self::default()
    }

    /// Refuses buffers of more than this many bytes, as a device does.
    pub fn limit_buffers(&mut self, bytes: u64) {
        self.largest_buffer = Some(self.largest_buffer.map_or(bytes, |most| most.min(bytes)));
    }

    /// Words of a buffer up to the last one that is neither zero nor [`NONE`]: what is in use of it, for
    /// counts of what stages move.
    pub fn words_in_use(&self, buffer: BufferId) -> usize {
        let is_used = |word: &u32| ![0, NONE].contains(word);
        self.content(buffer).iter().rposition(is_used).map_or(0, |last| last + 1)
    }

    /// The content of a buffer.
    pub fn words_of(&self, buffer: BufferId) -> Vec<u32> {
        self.content(buffer).clone()
    }

    pub(super) fn dispatch(&self, dispatch: &Dispatch) {
        if dispatch.arguments.is_some_and(|(buffer, place)| self.content(buffer)[3 * place] == 0) {
            return;
        }
        let buffers: Vec<&RefCell<Vec<u32>>> =
            dispatch.buffers.iter().map(|buffer| &self.buffers[buffer.0 as usize]).collect();
        (dispatch.stage.twin)(Bound::new(&buffers, &dispatch.params, dispatch.workgroups()));
    }

    pub(super) fn write(&self, buffer: BufferId, words: &[u32]) {
        self.buffers[buffer.0 as usize].borrow_mut()[..words.len()].copy_from_slice(words);
    }

    pub(super) fn content(&self, buffer: BufferId) -> Ref<'_, Vec<u32>> {
        self.buffers[buffer.0 as usize].borrow()
    }
}

impl Engine for TwinEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let bytes = 4 * words.max(SMALLEST_BUFFER) as u64;
        if let Some(most) = self.largest_buffer.filter(|most| bytes > *most) {
            return Err(GpuError::TooLarge { adapter: "the CPU".to_owned(), what: label, bytes, most });
        }
        self.work.buffers += 1;
        self.buffers.push(RefCell::new(vec![0; words.max(SMALLEST_BUFFER)]));
        Ok(BufferId(self.buffers.len() as u32 - 1))
    }

    fn free(&mut self, buffer: BufferId) {
        *self.buffers[buffer.0 as usize].borrow_mut() = Vec::new();
    }

    fn clear(&mut self) {
        self.buffers.clear();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.content(buffer).len()
    }

    fn most_words(&self) -> usize {
        self.largest_buffer.map_or(usize::MAX, |bytes| (bytes / 4) as usize)
    }

    fn work(&self) -> DeviceWork {
        self.work
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        self.work.count(recording.dispatch_count(), read.len());
        for command in &recording.commands {
            match command {
                Command::Write { buffer, words } => self.write(*buffer, words),
                Command::Dispatch(dispatch) => self.dispatch(dispatch),
            }
        }
        Ok(read.iter().map(|&(buffer, words)| self.content(buffer)[..words].to_vec()).collect())
    }
}
