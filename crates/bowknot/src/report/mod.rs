//! One self-contained HTML page of a run: it plays the frames beside plots of the statistics, from a file, without a
//! network.
//!
//! ```text
//! frames.rs    where the frames of a run's folder are
//! bodies.rs    the first frame split into bodies, with names from scene.toml
//! codec.rs     quantised positions, predicted, deflated, base64
//! pack.rs      which frames go in: two passes over the folder, the budget kept by a stride
//! columns.rs   stats.jsonl as columns
//! facts.rs     what the page says in words: scene, counts, machine, what was left out
//! page.rs      the parts put together
//! assets/      the page itself (HTML, CSS, scripts) and the libraries in it, with their licences
//! ```
//!
//! Only what the page keeps is held in memory: at most [`ReportOptions::max_bytes`], and two frames.

mod bodies;
mod codec;
mod columns;
mod facts;
mod frames;
mod pack;
mod page;
#[cfg(test)]
mod tests;

use crate::io::IoError;
use std::path::{Path, PathBuf};

/// What goes into a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportOptions {
    /// Every how many frames one is shown; none: as few are left out as the budget demands. The last frame is always
    /// shown. Default none.
    pub stride: Option<usize>,
    /// Largest size of the page [bytes]. Larger: more frames, and browsers take longer to open it. Default 30 MB.
    pub max_bytes: u64,
}

impl Default for ReportOptions {
    fn default() -> Self {
        Self { stride: None, max_bytes: 30_000_000 }
    }
}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportInfo {
    /// The page.
    pub path: PathBuf,
    /// Its size [bytes].
    pub bytes: u64,
    /// Frames that it plays.
    pub frames: usize,
    /// Frames that the folder holds.
    pub frames_found: usize,
    /// Every how many of them one is shown.
    pub stride: usize,
    /// Largest distance between a vertex of the page and of the frame [m].
    pub position_error_m: f64,
    /// What the page leaves out, in words.
    pub left_out: Vec<String>,
}

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A file that cannot be read or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A folder without frames.
    #[error(
        "{}: no frames in it (frames/*.ply, frames/*.obj or frames.npz): give the folder of a run", path.display()
    )]
    NoFrames {
        /// The folder.
        path: PathBuf,
    },
    /// A frame of another number of vertices than the first.
    #[error("{}: it has {found} vertices, the first frame has {expected}: frames of one run have the same", path.display())]
    Mismatch {
        /// The frame.
        path: PathBuf,
        /// Its number of vertices.
        found: usize,
        /// That of the first frame.
        expected: usize,
    },
    /// Not even two frames fit, or not as many as a given stride asks for.
    #[error("{frames} frames with a stride of {stride} take more than {budget} bytes: {remedy}")]
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

/// Writes the page of the run in `folder` to `out`, atomically. `progress` hears of frames read and to be read; the
/// second number grows when the budget turns out to demand another pass.
///
/// # Errors
/// A folder without frames, a frame that is malformed or does not fit the first, a budget too small, an output that
/// cannot be written. Statistics and scene may be missing or damaged: the page then says so.
pub fn write_report(
    folder: &Path,
    out: &Path,
    options: &ReportOptions,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<ReportInfo, ReportError> {
    if options.stride == Some(0) {
        return Err(ReportError::Option("the stride must be at least 1"));
    }
    let frames = frames::find(folder)?;
    let facts = facts::Facts::read(folder);
    let columns = columns::Columns::read(&folder.join("stats.jsonl"))?;
    let bodies = bodies::split(&frames.read(0)?, &facts.bodies);
    let fixed = page::fixed_bytes(&frames, &facts, &columns);
    let pack = pack::pack(&frames, bodies, options, fixed, progress)?;
    page::write(out, folder, &frames, &facts, &columns, &pack)
}
