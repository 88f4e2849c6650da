//! One run at a time in a folder.
//!
//! The lock is the operating system's, on the file `checkpoint/lock`. It ends with the process, however that
//! ends: a killed run leaves the file, but not the lock, and nothing is in the way of `--resume`. The file
//! stays, because removing it would let a second run lock the removed file while a third makes another.

use crate::simulator::SimulationError;
use bowknot_io::{IoError, create_folder};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The file below the folder of a run.
pub(super) const LOCK: &str = "checkpoint/lock";

/// Holds the folder of a run until it is dropped.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    file: File,
}

impl Lock {
    /// Takes the folder, which is created.
    ///
    /// # Errors
    /// A folder that another run writes to, or that cannot be written.
    pub fn take(folder: &Path) -> Result<Self, SimulationError> {
        let path = folder.join(LOCK);
        create_folder(path.parent().unwrap_or(folder))?;
        let system = |source| IoError::system("write", &path, source);
        let mut options = OpenOptions::new();
        let mut file =
            options.create(true).truncate(false).read(true).write(true).open(&path).map_err(system)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(SimulationError::RunInUse { path: folder.to_owned(), process: owner(&mut file) });
            }
            // Some network file systems have no locks. Runs there were never guarded.
            Err(TryLockError::Error(error)) => {
                tracing::warn!(
                    "{}: cannot be locked ({error}): see that no other run uses it",
                    path.display()
                );
            }
        }
        Ok(Self { path, file })
    }

    /// Writes the number of this process into the file, for messages. Returns that of the run before, if any.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn sign(&mut self) -> Result<Option<u32>, IoError> {
        let before = owner(&mut self.file);
        let id = std::process::id().to_string();
        let mut write = || {
            self.file.seek(SeekFrom::Start(0))?;
            self.file.write_all(id.as_bytes())?;
            self.file.set_len(id.len() as u64)
        };
        write().map_err(|source| IoError::system("write", &self.path, source))?;
        Ok(before)
    }
}

/// The process that holds the lock, if it can be read.
fn owner(file: &mut File) -> Option<u32> {
    let mut text = String::new();
    file.take(16).read_to_string(&mut text).ok()?;
    text.parse().ok()
}
