//! Work for an engine: recorded first, run later, by kernels or by their twins.

use crate::stages::Stage;
use bytemuck::Pod;

/// Names a buffer of an [engine](crate::Engine).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferId(pub(crate) u32);

/// A step of a recording.
#[derive(Clone, Debug)]
pub(crate) enum Command {
    /// Overwrites the first words of a buffer.
    Write { buffer: BufferId, words: Vec<u32> },
    /// Runs a stage.
    Dispatch(Dispatch),
}

/// A run of a stage.
#[derive(Clone, Debug)]
pub(crate) struct Dispatch {
    pub stage: &'static Stage,
    /// Buffers in the order of the stage's bindings.
    pub buffers: Vec<BufferId>,
    /// The parameters, as words.
    pub params: Vec<u32>,
    /// Number of threads that have work.
    pub threads: usize,
}

/// A list of commands, which run in order: each sees all that those before it have written.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    pub(crate) commands: Vec<Command>,
}

impl Recording {
    /// Overwrites the first entries of a buffer.
    pub fn write<T: Pod>(&mut self, buffer: BufferId, entries: &[T]) {
        let words = bytemuck::cast_slice(entries).to_vec();
        self.commands.push(Command::Write { buffer, words });
    }

    /// Runs a stage with one thread for each of `threads` pieces of work.
    pub(crate) fn dispatch<P: Pod>(
        &mut self,
        stage: &'static Stage,
        buffers: &[BufferId],
        params: P,
        threads: usize,
    ) {
        debug_assert_eq!(buffers.len(), stage.bindings.len(), "{}", stage.name);
        if threads > 0 {
            let params = bytemuck::cast_slice(&[params]).to_vec();
            self.commands.push(Command::Dispatch(Dispatch {
                stage,
                buffers: buffers.to_vec(),
                params,
                threads,
            }));
        }
    }

    /// Number of words of 32 bits that are written to buffers.
    pub fn words_written(&self) -> usize {
        let words = |command: &Command| match command {
            Command::Write { words, .. } => words.len(),
            Command::Dispatch(_) => 0,
        };
        self.commands.iter().map(words).sum()
    }

    /// Number of stages that run.
    pub fn dispatch_count(&self) -> usize {
        self.commands.iter().filter(|command| matches!(command, Command::Dispatch(_))).count()
    }
}
