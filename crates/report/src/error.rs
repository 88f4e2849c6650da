//! Why there is no page.

use bowknot_errors::counted;
use bowknot_io::IoError;
use std::path::PathBuf;

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A file that cannot be read or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A folder without frames.
    #[error(
        "{}: no frames in it (frames/*.ply, frames/*.obj or frames.npz): give the folder of a \
         run", path.display()
    )]
    NoFrames {
        /// The folder.
        path: PathBuf,
    },
    /// A frame of another number of vertices than the first.
    #[error(
        "{}: it has {}, the first frame has {expected}: frames of one run have the same",
        path.display(), counted(*found, "vertex", "vertices")
    )]
    Mismatch {
        /// The frame.
        path: PathBuf,
        /// Its number of vertices.
        found: usize,
        /// That of the first frame.
        expected: usize,
    },
    /// Not even two frames fit, or not as many as a given stride asks for.
    #[error(
        "{} with a stride of {stride} need more than {budget} bytes: {remedy}",
        counted(*frames, "frame", "frames")
    )]
    TooLarge {
        /// Frames that would be shown.
        frames: usize,
        /// The stride.
        stride: usize,
        /// The budget [bytes].
        budget: u64,
        /// What helps.
        remedy: &'static str,
    },
    /// An option out of its range.
    #[error("{0}")]
    Option(&'static str),
}
