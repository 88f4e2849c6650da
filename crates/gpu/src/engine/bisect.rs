//! Runs some stages on the device and the others by their twins, to find the first wrong kernel.

use super::device::DeviceEngine;
use super::traits::Engine;
use super::twin::TwinEngine;
use crate::error::GpuError;
use crate::recording::{BufferId, Command, Recording};

/// Runs the first stages of all dispatches by twins and the others on the device. All buffers are copied when the
/// device takes over.
///
/// If a result is wrong with `from` and right with `from + 1`, then dispatch `from` is the first wrong one.
#[derive(Debug)]
pub struct BisectingEngine {
    device: DeviceEngine,
    twin: TwinEngine,
    /// Number of the first dispatch that runs on the device.
    from: usize,
    /// Dispatches that twins have run.
    count: usize,
    /// Whether the device has taken over.
    on_device: bool,
    buffers: Vec<BufferId>,
}

impl BisectingEngine {
    /// Dispatches `from` and later ones run on the device, those before by twins.
    pub fn new(device: DeviceEngine, from: usize) -> Self {
        Self { device, twin: TwinEngine::new(), from, count: 0, on_device: false, buffers: Vec::new() }
    }
}

impl Engine for BisectingEngine {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        let buffer = self.device.buffer(label, words)?;
        let twin = self.twin.buffer(label, words)?;
        debug_assert_eq!(buffer, twin);
        self.buffers.push(buffer);
        Ok(buffer)
    }

    fn free(&mut self, buffer: BufferId) {
        self.device.free(buffer);
        self.twin.free(buffer);
        self.buffers.retain(|kept| *kept != buffer);
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.twin.words(buffer)
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        let mut rest = Recording::default();
        for command in &recording.commands {
            match command {
                Command::Dispatch(dispatch) if rest.commands.is_empty() && self.count < self.from => {
                    self.count += 1;
                    self.twin.dispatch(dispatch);
                }
                Command::Write { buffer, words } if rest.commands.is_empty() && self.count < self.from => {
                    self.twin.write(*buffer, words)
                }
                _ => rest.commands.push(command.clone()),
            }
        }
        if !self.on_device {
            if rest.commands.is_empty() {
                return self.twin.run(&rest, read);
            }
            let mut upload = Recording::default();
            for &buffer in &self.buffers {
                upload.write(buffer, &self.twin.content(buffer));
            }
            self.device.run(&upload, &[])?;
            self.on_device = true;
        }
        self.device.run(&rest, read)
    }
}
