//! Work for an engine: recorded first, run later, by kernels or by their twins.

use crate::stages::{Access, Stage};
use bytemuck::Pod;

/// Names a buffer of an [engine](crate::Engine).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BufferId(pub(crate) u32);

/// What a part of a two-way step is for. Engines with time stamps measure the seconds of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Candidate pairs.
    Search,
    /// Contact geometry of the candidate pairs.
    Evaluate,
    /// Rows and their sweeps.
    Backward,
    /// Paths, step sizes and the move.
    Forward,
}

impl Phase {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Search, Self::Evaluate, Self::Backward, Self::Forward];
}

/// A step of a recording.
#[derive(Clone, Debug)]
pub(crate) enum Command {
    /// Overwrites the first words of a buffer.
    Write { buffer: BufferId, words: Vec<u32> },
    /// Runs a stage.
    Dispatch(Dispatch),
}

/// Most workgroups of a dispatch, which every device runs.
pub(crate) const MAX_WORKGROUPS: usize = 65535;

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
    /// Where its number of workgroups is if a stage may take it away: a buffer with three words per dispatch,
    /// and the place in it.
    pub arguments: Option<(BufferId, usize)>,
    /// What it is for, if that is measured.
    pub phase: Option<Phase>,
}

impl Dispatch {
    /// Workgroups for all threads. Kernels go on with strides, so any number of workgroups does all of the
    /// work.
    pub fn workgroups(&self) -> usize {
        self.threads.div_ceil(self.stage.workgroup).min(MAX_WORKGROUPS)
    }
}

/// A run of a stage as other crates see it, to count what steps need.
#[derive(Clone, Debug)]
pub struct DispatchView<'a> {
    /// Name of the stage.
    pub stage: &'static str,
    /// What it is for; None outside of two-way steps.
    pub phase: Option<Phase>,
    /// Threads that have work; 1 for a stage of which one workgroup does everything.
    pub threads: usize,
    /// Threads of a workgroup.
    pub workgroup: usize,
    /// Buffers in the order of the stage's bindings.
    pub buffers: &'a [BufferId],
    /// Whether it writes them.
    pub writes: Vec<bool>,
}

/// A list of commands, which run in order: each sees all that those before it have written.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    pub(crate) commands: Vec<Command>,
    phase: Option<Phase>,
}

impl Recording {
    /// Overwrites the first entries of a buffer.
    pub fn write<T: Pod>(&mut self, buffer: BufferId, entries: &[T]) {
        let words = bytemuck::cast_slice(entries).to_vec();
        self.commands.push(Command::Write { buffer, words });
    }

    /// Takes all writes to a buffer back.
    pub(crate) fn forget(&mut self, buffer: BufferId) {
        self.commands.retain(
            |command| !matches!(command, Command::Write { buffer: written, .. } if *written == buffer),
        );
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
                arguments: None,
                phase: self.phase,
            }));
        }
    }

    /// Adds what another recording does, if a stage before it leaves it: the numbers of workgroups of its
    /// dispatches are in `arguments` when they run, and a dispatch without workgroups does nothing.
    /// Dispatches that bind that buffer themselves run in any case. Returns the number of dispatches with
    /// arguments so far, of which there were `before`.
    pub(crate) fn append_conditional(&mut self, other: &Self, arguments: BufferId, before: usize) -> usize {
        let mut place = before;
        for command in &other.commands {
            let mut command = command.clone();
            if let Command::Dispatch(dispatch) = &mut command
                && !dispatch.buffers.contains(&arguments)
            {
                dispatch.arguments = Some((arguments, place));
                place += 1;
            }
            self.commands.push(command);
        }
        place
    }

    /// Fills `arguments` at the start with the workgroups of all dispatches that have theirs there.
    pub(crate) fn fill_arguments(&mut self, arguments: BufferId) {
        let with_arguments = |command: &Command| match command {
            Command::Dispatch(dispatch) if dispatch.arguments.is_some() => Some(dispatch.workgroups()),
            _ => None,
        };
        let counts = self.commands.iter().filter_map(with_arguments);
        let words: Vec<u32> = counts.flat_map(|count| [count as u32, 1, 1]).collect();
        if !words.is_empty() {
            self.commands.insert(0, Command::Write { buffer: arguments, words });
        }
    }

    /// Says what the next dispatches are for.
    pub(crate) fn begin_phase(&mut self, phase: Phase) {
        self.phase = Some(phase);
    }

    /// The stages that run, in their order.
    pub fn dispatches(&self) -> impl Iterator<Item = DispatchView<'_>> {
        self.commands.iter().filter_map(|command| match command {
            Command::Dispatch(dispatch) => Some(DispatchView {
                stage: dispatch.stage.name,
                phase: dispatch.phase,
                threads: dispatch.threads,
                workgroup: dispatch.stage.workgroup,
                buffers: &dispatch.buffers,
                writes: dispatch.stage.bindings.iter().map(|access| *access == Access::Write).collect(),
            }),
            Command::Write { .. } => None,
        })
    }

    /// Each command alone, in their order: to look at buffers in between.
    pub fn parts(&self) -> impl Iterator<Item = Self> {
        self.commands.iter().map(|command| Self { commands: vec![command.clone()], phase: None })
    }

    /// Words that the host writes.
    pub fn words_written(&self) -> usize {
        let words =
            |command: &Command| if let Command::Write { words, .. } = command { words.len() } else { 0 };
        self.commands.iter().map(words).sum()
    }

    /// Number of stages that run.
    pub fn dispatch_count(&self) -> usize {
        self.commands.iter().filter(|command| matches!(command, Command::Dispatch(_))).count()
    }
}
