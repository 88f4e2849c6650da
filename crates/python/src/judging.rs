//! Files judged: meshes, animations, runs.

use crate::compute::compute;
use crate::error;
use crate::meshes::up_of;
use bowknot::io::{FrameOptions, Import};
use bowknot::judging::{JudgingError, JudgingObserver, JudgingParams, judge_files};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// How files are judged.
#[derive(FromPyObject)]
pub struct Judging {
    up: String,
    scale: f64,
    fps: Option<f64>,
    together: bool,
    between_frames: bool,
    obstacles: Vec<String>,
    may_intersect: Vec<String>,
    leave_out: Vec<String>,
    min_distance: Option<f64>,
    limit: usize,
}

/// Ends when a signal comes, and passes warnings on.
struct Watch<'a>(&'a AtomicBool);

impl JudgingObserver for Watch<'_> {
    fn progressed(&mut self, _: usize, _: usize) -> bool {
        !self.0.load(Ordering::Relaxed)
    }

    fn warned(&mut self, text: &str) {
        tracing::warn!("{text}");
    }
}

/// What the judge says of all frames of some files, as JSON.
#[pyfunction]
pub fn check_files(py: Python<'_>, paths: Vec<PathBuf>, judging: Judging) -> PyResult<String> {
    let params = JudgingParams {
        frames: FrameOptions {
            import: Import { up: up_of(&judging.up)?, scale: judging.scale },
            rate: judging.fps,
            ..FrameOptions::default()
        },
        together: judging.together,
        paths: judging.between_frames,
        obstacles: judging.obstacles,
        may_intersect_themselves: judging.may_intersect,
        left_out: judging.leave_out,
        min_distance: judging.min_distance,
        listed: judging.limit,
    };
    let judged = compute(py, |stop| judge_files(&paths, &params, &mut Watch(stop)))?;
    let report = judged.finish()?.map_err(|failed: JudgingError| error::input(failed))?;
    serde_json::to_string(&report).map_err(error::internal)
}
