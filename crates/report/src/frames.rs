//! The frames of a run's folder.

use crate::error::ReportError;
use bowknot_io::FrameSource;
use std::path::Path;

/// Finds `frames/*.ply`, else `frames/*.obj`, else `frames.npz`.
pub(super) fn find(folder: &Path) -> Result<FrameSource, ReportError> {
    if let Some(frames) = FrameSource::of_folder(&folder.join("frames"))? {
        return Ok(frames);
    }
    let archive = folder.join("frames.npz");
    let frames = if archive.exists() { FrameSource::of_archive(&archive)? } else { None };
    frames.ok_or_else(|| ReportError::NoFrames { path: folder.to_owned() })
}
