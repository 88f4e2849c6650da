//! The checkpoints in the folder of a run: the last one, and the one before it.
//!
//! A new checkpoint is written as a whole under a third name. Only then is the last one renamed to the
//! previous, and the new one to the last. So at any moment one whole checkpoint exists, and two from the
//! second one on.

use crate::simulator::Checkpoint;
use bowknot_errors::counted;
use bowknot_io::IoError;
use std::fs;
use std::path::{Path, PathBuf};

const LAST: &str = "state.npz";
const PREVIOUS: &str = "previous.npz";
/// A run that dies between the two renamings leaves this one.
const NEXT: &str = "next.npz";

/// The checkpoints of a run.
#[derive(Clone, Debug)]
pub(super) struct Saved {
    folder: PathBuf,
    /// Time steps of the last checkpoint that was read or written.
    step: Option<usize>,
}

impl Saved {
    /// The checkpoints of the run in this folder.
    pub fn new(run: &Path) -> Self {
        Self { folder: run.join("checkpoint"), step: None }
    }

    /// Writes a checkpoint and keeps the one before it. One that was written already is not written again.
    ///
    /// # Errors
    /// The system's refusal; the checkpoints so far then stay.
    pub fn write(&mut self, checkpoint: &Checkpoint) -> Result<(), IoError> {
        if self.step == Some(checkpoint.step) {
            return Ok(());
        }
        let [next, last, previous] = [NEXT, LAST, PREVIOUS].map(|name| self.folder.join(name));
        checkpoint.write(&next)?;
        let system = |path: &Path| {
            let path = path.to_owned();
            move |source| IoError::system("write", &path, source)
        };
        // After a resumption from an earlier checkpoint the last one is damaged, and the previous one is
        // sound.
        if last.exists() && self.step.is_some() {
            fs::rename(&last, &previous).map_err(system(&previous))?;
        }
        fs::rename(&next, &last).map_err(system(&last))?;
        self.step = Some(checkpoint.step);
        Ok(())
    }

    /// The last checkpoint that can be read; none if there is no file of one. Says in the log if an older one
    /// is taken because of damage.
    ///
    /// # Errors
    /// No file can be read; what is wrong with the last one.
    pub fn latest(&mut self) -> Result<Option<Checkpoint>, IoError> {
        let mut first_error = None;
        for name in [LAST, NEXT, PREVIOUS] {
            let path = self.folder.join(name);
            if !path.exists() {
                continue;
            }
            match Checkpoint::read(&path) {
                Ok(checkpoint) => {
                    if let Some(error) = first_error {
                        let steps = counted(checkpoint.step, "time step", "time steps");
                        tracing::warn!("{error}; going on from the checkpoint before it, after {steps}");
                    }
                    // The last file is overwritten, not kept as the previous one, if it is damaged.
                    self.step = (name == LAST).then_some(checkpoint.step);
                    return Ok(Some(checkpoint));
                }
                Err(error) => first_error = first_error.or(Some(error)),
            }
        }
        first_error.map_or(Ok(None), Err)
    }
}
