//! How a command ends.

use bowknot::check::CheckError;
use bowknot::io::IoError;
use std::fmt::Display;
use std::path::Path;

/// A command that did what was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Done {
    /// Exit code 0.
    Fine,
    /// A check found an intersection or too small a distance: exit code 1.
    Found,
    /// Interrupted, with a valid state on disk: exit code 130.
    Interrupted,
}

/// A command that could not do what was asked.
#[derive(Debug)]
pub struct Failure {
    /// Exit code.
    pub code: u8,
    /// What, where, and the remedy.
    pub message: String,
}

impl Failure {
    /// Bad input of any kind, unwritable output included: exit code 2.
    pub fn input(message: impl Display) -> Self {
        Self { code: 2, message: message.to_string() }
    }

    /// No such backend or device: exit code 3.
    pub fn backend(message: impl Display) -> Self {
        Self { code: 3, message: message.to_string() }
    }

    /// A file that cannot be judged.
    pub fn judge(path: &Path, error: &CheckError) -> Self {
        Self::input(format!("{}: {error}", path.display()))
    }
}

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        Self::input(error)
    }
}
