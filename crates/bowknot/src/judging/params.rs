//! What is judged, and what is exempt.

use crate::io::FrameOptions;
use bowknot_errors::{Checks, Parameters};

/// How files are judged. Names of parts may hold `*`, which stands for any characters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JudgingParams {
    /// How frames are read: axes, unit, and frames per second of files that have motion but no frames.
    pub frames: FrameOptions,
    /// Whether the files of all paths are parts of one scene, which are judged together, frame by frame.
    pub together: bool,
    /// Whether the straight paths between successive frames are judged as well. What meets there and does not
    /// intersect before is a hint, not an intersection: nobody knows how it moved between two frames. The paths
    /// of a `trace` are always judged, and count, since that is how it moved.
    pub paths: bool,
    /// Parts that are obstacles: they may intersect themselves and each other.
    pub obstacles: Vec<String>,
    /// Parts that may intersect themselves.
    pub may_intersect_themselves: Vec<String>,
    /// Parts that are not judged at all.
    pub left_out: Vec<String>,
    /// Distance below which two elements without a common vertex are too near [m]; none: 0.
    pub min_distance: Option<f64>,
    /// How many intersections of each state and path are described at most; all are counted.
    pub listed: usize,
}

impl Parameters for JudgingParams {
    fn check(&self, checks: &mut Checks) {
        if let Some(distance) = self.min_distance {
            checks.positive("min_distance", distance);
        }
        checks.positive("frames.import.scale", self.frames.import.scale);
        if let Some(rate) = self.frames.rate {
            checks.positive("frames.rate", rate);
        }
    }
}
