//! What a page is asked to hold, and what it came to hold.

use std::path::PathBuf;

/// What goes into a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportOptions {
    /// Every how many frames one is shown; none: as few are left out as the budget demands. The last frame is
    /// always shown. Default none.
    pub stride: Option<usize>,
    /// Largest size of the page [bytes]. Larger: more frames, and browsers take longer to open it. Default 30
    /// MB.
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
