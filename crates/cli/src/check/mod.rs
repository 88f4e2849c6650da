//! `bowknot check`: judges states, animations, and the straight paths between frames.

#[cfg(feature = "render")]
mod picture;
mod smallest;
mod table;
mod text;

use crate::args::CheckOptions;
use crate::exit::{Exit, Failure};
use crate::progress::Bar;
use crate::{failure_dump, output};
use bowknot::check::StateOptions;
use bowknot::io::{FrameOptions, Import};
use bowknot::judging::{JudgedState, JudgingError, JudgingObserver, JudgingParams, judge_files};
use bowknot_errors::counted;
use std::path::{Path, PathBuf};

pub fn check(options: &CheckOptions) -> Result<Exit, Failure> {
    let inputs: Vec<&Path> = options.paths.iter().map(PathBuf::as_path).collect();
    for out in [&options.dump, &options.table].into_iter().flatten() {
        output::refuse_overwrite(out, &inputs)?;
    }
    if let Some(table) = &options.table {
        output::refuse_unwritable(table, "csv")?;
    }
    if let Some(dump) = &options.dump_on_failure {
        failure_dump::refuse(dump, &inputs)?;
    }
    #[cfg(feature = "render")]
    if let Some(picture) = &options.picture {
        output::refuse_unwritable(picture, "png")?;
    }
    let params = JudgingParams {
        frames: FrameOptions {
            import: Import {
                up: options.up.map(Into::into).unwrap_or_default(),
                scale: options.scale.unwrap_or(1.0),
            },
            rate: options.fps,
            ..FrameOptions::default()
        },
        together: options.together,
        paths: options.between_frames,
        obstacles: options.obstacle.clone(),
        may_intersect_themselves: options.may_intersect.clone(),
        left_out: options.leave_out.clone(),
        min_distance: options.min_distance,
        listed: options.list,
    };
    let bar = Bar::new(0, "states", false);
    let mut watch = Watch { options, bar, is_shown: false, notes: Vec::new(), smallest: None, failure: None };
    let judged = judge_files(&options.paths, &params, &mut watch);
    watch.bar.finish();
    if let Some(failure) = watch.failure {
        return Err(failure);
    }
    let report = judged?;

    if let Some(file) = &options.table {
        table::write(file, &report)?;
    }
    if options.json {
        output::print_json(&report)?;
    } else {
        output::print(&text::of(&report, options))?;
    }
    for note in &watch.notes {
        if options.json { eprintln!("{note}") } else { output::print(note)? }
    }
    if let Some(smallest) = watch.smallest {
        eprintln!("{smallest}");
    }
    Ok(if report.clear { Exit::Success } else { Exit::CheckFailed })
}

impl From<JudgingError> for Failure {
    fn from(error: JudgingError) -> Self {
        Self::input(error)
    }
}

/// Shows progress, and writes what is asked for of the first state that intersects.
struct Watch<'a> {
    options: &'a CheckOptions,
    bar: Bar,
    /// Whether a state that intersects was met.
    is_shown: bool,
    /// What was written, in words.
    notes: Vec<String>,
    /// The smallest state that was written, in words.
    smallest: Option<String>,
    failure: Option<Failure>,
}

impl JudgingObserver for Watch<'_> {
    fn progressed(&mut self, done: usize, total: usize) -> bool {
        self.bar.set_total(total);
        self.bar.set_position(done, "");
        true
    }

    fn warned(&mut self, text: &str) {
        self.bar.print(&format!("warning: {text}"));
    }

    fn intersected(&mut self, state: &JudgedState<'_>) -> bool {
        if std::mem::replace(&mut self.is_shown, true) {
            return true;
        }
        self.failure = self.write(state).err();
        self.failure.is_none()
    }
}

impl Watch<'_> {
    /// Writes the files that show a state that intersects.
    fn write(&mut self, state: &JudgedState<'_>) -> Result<(), Failure> {
        let Self { options, notes, smallest, .. } = self;
        let all = StateOptions { limit: usize::MAX, distance: false };
        if let Some(file) = &options.dump {
            let report = state.judge.check_state(state.positions, &all).map_err(Failure::input)?;
            let offending = state.judge.offending_mesh(state.positions, &report.intersections);
            let of_vertex = |list: Option<&Vec<u32>>| -> Vec<u32> {
                list.map_or_else(Vec::new, |list| {
                    offending.vertices.iter().map(|&v| list[v as usize]).collect()
                })
            };
            let flags = |list: &Vec<bool>| offending.vertices.iter().map(|&v| list[v as usize]).collect();
            let obstacle: Vec<bool> = state.mesh.obstacle.as_ref().map_or_else(Vec::new, flags);
            crate::dump::write(file, &offending, &obstacle, &of_vertex(state.mesh.body.as_ref()))?;
            let triangles = counted(offending.triangles.len(), "triangle", "triangles");
            notes.push(format!("wrote {triangles} to {}", file.display()));
        }
        if let Some(file) = &options.dump_on_failure {
            let states = state.problem.cloned().unwrap_or_else(|| smallest::state_of(state));
            *smallest = Some(smallest::write(file, &states)?);
        }
        #[cfg(feature = "render")]
        if let Some(file) = &options.picture {
            notes.push(picture::write(file, state)?);
        }
        Ok(())
    }
}
