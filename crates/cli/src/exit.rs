//! How a command ends: exit codes and error messages.

use crate::hints::Hint;
use bowknot::SimulationError;
use bowknot::io::IoError;
use std::fmt::Display;

/// The end of a command that did what was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Exit code 0.
    Success,
    /// A check found an intersection or too small a distance: exit code 1.
    CheckFailed,
    /// Interrupted, with a valid state on disk: exit code 130.
    Interrupted,
}

/// The end of a command that could not do what was asked.
#[derive(Debug)]
pub struct Failure {
    /// Exit code.
    pub code: u8,
    /// What is wrong, where, and the remedy.
    pub message: String,
}

impl Failure {
    /// Bad input of any kind or output that cannot be written: exit code 2.
    pub fn input(message: impl Display) -> Self {
        Self { code: 2, message: message.to_string() }
    }

    /// No such backend or device: exit code 3.
    pub fn backend(message: impl Display) -> Self {
        Self { code: 3, message: message.to_string() }
    }

    /// A fault of the program itself: exit code 4.
    pub fn internal(message: impl Display) -> Self {
        Self { code: 4, message: message.to_string() }
    }

    /// A simulation that could not begin or go on: exit code 4, 3 or 2.
    pub fn simulation(error: &SimulationError) -> Self {
        let message = error.with_hint();
        match error {
            SimulationError::Internal { .. } => Self::internal(message),
            SimulationError::Backend { .. } => Self::backend(message),
            _ => Self::input(message),
        }
    }
}

impl From<IoError> for Failure {
    fn from(error: IoError) -> Self {
        Self::input(error)
    }
}
