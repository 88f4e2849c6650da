//! From the folder of a run to its page.

use crate::error::ReportError;
use crate::options::{ReportInfo, ReportOptions};
use crate::{bodies, columns, facts, frames, pack, page};
use std::path::Path;

/// Writes the page of the run in `folder` to `out`, atomically. `progress` hears of frames read and to be
/// read; the second number grows when the budget turns out to demand another pass.
///
/// # Errors
/// A folder without frames, a frame that is malformed or does not fit the first, a budget too small, an
/// output that cannot be written. Statistics and scene may be missing or damaged: the page then says so.
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
