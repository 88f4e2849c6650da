//! What is wrong with a file, and where.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IoError {
    /// The operating system refuses.
    #[error("cannot {action} {}: {}", path.display(), reason(source))]
    System {
        /// "read", "write" or "create".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The content is not what the format allows, or holds numbers that no simulation can use.
    #[error("{}{place}: {message}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Where in the file.
        place: Place,
        /// What is wrong and what is allowed.
        message: String,
    },
    /// A sound mesh file without vertices.
    #[error("{}: {message}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: &'static str,
    },
}

/// Where in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0.
    Byte(usize),
    /// An element of a binary file, counted from 0, such as vertex 17.
    Element(String, usize),
    /// An array of an archive.
    Array(String),
    /// A prim of a stage or a node of a scene, by its path or name.
    Prim(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ": byte {byte}"),
            Self::Element(name, index) => write!(f, ": {name} {index}"),
            Self::Array(name) => write!(f, ": array {name}"),
            Self::Prim(path) => write!(f, ": {path}"),
        }
    }
}

impl IoError {
    /// A refusal by the system.
    pub fn system(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Self::System { action, path: path.to_owned(), source }
    }

    /// A fault in the content.
    pub fn content(path: &Path, place: Place, message: impl Into<String>) -> Self {
        Self::Content { path: path.to_owned(), place, message: message.into() }
    }

    /// The file that is at fault.
    pub fn path(&self) -> &Path {
        match self {
            Self::System { path, .. } | Self::Content { path, .. } | Self::Empty { path, .. } => path,
        }
    }
}

/// The common reasons in plain words; the system's own text otherwise.
fn reason(source: &std::io::Error) -> String {
    use std::io::ErrorKind as Kind;
    match source.kind() {
        Kind::NotFound => "no such file or folder".to_owned(),
        Kind::PermissionDenied => "permission denied".to_owned(),
        Kind::StorageFull => "the disk is full".to_owned(),
        Kind::QuotaExceeded => "the disk quota is used up".to_owned(),
        Kind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
        Kind::IsADirectory => "it is a folder".to_owned(),
        Kind::NotADirectory => "a part of the path is not a folder".to_owned(),
        _ => source.to_string(),
    }
}
