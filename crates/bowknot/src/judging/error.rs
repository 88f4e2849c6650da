//! Why files could not be judged.

use crate::check::CheckError;
use crate::io::IoError;
use bowknot_errors::{Errors, ParamError};
use std::path::PathBuf;

/// Why files could not be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JudgingError {
    /// Parameters out of their range.
    #[error("{0}")]
    Params(Errors<ParamError>),
    /// A file could not be read.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A mesh that cannot be judged.
    #[error("{}: {source}", file.display())]
    Check {
        /// The file.
        file: PathBuf,
        /// What is wrong with it.
        source: CheckError,
    },
    /// A collision problem, or files that do not fit together.
    #[error("{}: {message}", file.display())]
    Content {
        /// The file or folder.
        file: PathBuf,
        /// What is wrong with it, and the remedy.
        message: String,
    },
    /// No part has this name.
    #[error("no part is called {pattern:?}: the parts are {}", parts.join(", "))]
    NoSuchPart {
        /// What was asked for.
        pattern: String,
        /// Names of all parts.
        parts: Vec<String>,
    },
    /// The observer wanted to end.
    #[error("interrupted")]
    Interrupted,
}
