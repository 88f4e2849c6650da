//! Files judged: every frame of meshes, animations and runs, and the straight paths between frames.
//!
//! [`judge_files`] opens each path (`clips`), names the parts of each frame and marks those that are exempt
//! (`parts`), judges it by exact predicates ([`Judge`](crate::check::Judge)), and adds up what it finds
//! ([`JudgingReport`]). How progress is shown, and what is done with states that intersect, is up to a
//! [`JudgingObserver`].

mod clips;
mod elements;
mod error;
mod inside;
mod observer;
mod params;
mod parts;
mod report;
mod states;

pub use elements::PartElement;
pub use error::JudgingError;
pub use observer::{JudgedState, JudgingObserver};
pub use params::JudgingParams;
pub use report::{
    FrameVerdict, HintPair, HintPairOfFrame, InsidePair, JudgingReport, PartPair, PartPairOfFrame,
};

use bowknot_errors::Parameters;
use clips::{Clip, Frames};
use states::StateJudging;
use std::path::PathBuf;

/// Judges all frames of some files and folders, in order.
///
/// A path is a mesh, an animation, an archive of frames, a recorded collision problem, a folder of any of
/// them, or the folder of a run. Lengths are in the unit of the files, unless the parameters convert it.
///
/// # Errors
/// Parameters out of their range, files that cannot be read, meshes that cannot be judged, names of parts that do not exist, and an observer
/// that ends the work.
pub fn judge_files(
    paths: &[PathBuf],
    params: &JudgingParams,
    observer: &mut dyn JudgingObserver,
) -> Result<JudgingReport, JudgingError> {
    params.validate().map_err(JudgingError::Params)?;
    let clips = Clip::all_of(paths, params)?;
    parts::check_patterns(&clips, params)?;
    let mut judging = StateJudging::new(params, observer, clips.iter().map(Clip::len).sum());
    for clip in &clips {
        judging.begin(clip);
        for file in clip.files() {
            match clip.open(file, params)? {
                Frames::Problem(problem) => judging.problem(file, &problem)?,
                Frames::Meshes(source) => judging.frames(&source)?,
            }
        }
    }
    Ok(judging.into_report())
}
