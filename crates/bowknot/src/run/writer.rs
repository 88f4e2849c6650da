//! The output folder of a run.
//!
//! ```text
//! scene.toml                resolved scene
//! backends.json             what computes the run, see `backends.rs`
//! frames/000000.ply ..      one file per frame and format; other formats beside it, see `frames.rs`
//! surface/000000.obj        what the meshes say about their faces, if they do
//! fields/velocities.f64     and the like, if asked for, see `frames.rs`
//! stats.jsonl               one line per time step
//! summary.json              written at the end
//! checkpoint/state.npz      the state to resume from
//! checkpoint/previous.npz   the one before it, for the case that the last is damaged
//! checkpoint/lock           one run at a time, see `lock.rs`
//! checkpoint/frames.f64     the positions so far, for formats that are one file in the end
//! trace/STEP_ITER_L.ply     every x^(l), if asked for; L = 0 is where the problem starts
//! states/STEP_ITER.npz      the collision problems, if asked for
//! ```
//!
//! Files are written under another name first, so a reader, or a run that dies, finds whole files only. A
//! time step writes its frame, then its line of statistics, then the checkpoint: all that a checkpoint
//! builds on is there.

use super::differences::differences;
use super::frames::{FrameWriter, field_file};
use super::layout::Layout;
use super::lock::{LOCK, Lock};
use super::saved::Saved;
use super::summary::Totals;
use crate::recording::Recorder;
use crate::simulator::{CollisionProblem, SimulationError, Simulator, StepStatistics};
use bowknot_errors::counted;
use bowknot_geometry::{Point, Vector};
use bowknot_io::{self as io, Field, IoError, create_folder, write_ply};
use bowknot_scene::Scene;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What tells that a folder holds a run.
const PARTS: [&str; 13] = [
    "scene.toml",
    super::backends::FILE,
    "frames",
    "frames.npz",
    "frames.pvd",
    "scene.usda",
    "scene.glb",
    "fields",
    "pc2",
    "surface",
    "stats.jsonl",
    "summary.json",
    "checkpoint",
];

/// Writes the files of a run.
#[derive(Debug)]
pub struct RunWriter {
    folder: PathBuf,
    checkpoint_every: usize,
    frames: FrameWriter,
    recorder: Recorder,
    /// Which bodies and half-spaces are there in the time step that goes on.
    present: Vec<bool>,
    saved: Saved,
    statistics: File,
    /// Length of `stats.jsonl` up to its last whole line [bytes].
    statistics_length: u64,
    totals: Totals,
    /// Keeps other runs away.
    _lock: Lock,
}

/// Why the run of a folder cannot go on.
const NO_RUN: &str = "it holds no run";

/// Warns of formats that the run wrote so far and that are not continued.
fn warn_of_left_formats(text: &str, scene: &Scene) {
    let Ok(before) = Scene::from_toml(text, &scene.folder) else { return };
    let left: Vec<String> = before
        .output
        .formats
        .iter()
        .filter(|format| !scene.output.formats.contains(format))
        .map(|format| format!("{format:?}").to_lowercase())
        .collect();
    if !left.is_empty() {
        let left = left.join(", ");
        tracing::warn!(
            "the run wrote {left} as well, which this resumption does not continue: add it to \
             `output.formats`, or export the frames afterwards"
        );
    }
}

impl RunWriter {
    /// Begins a run in a folder, which is created, and writes the first frame.
    ///
    /// # Errors
    /// A folder that holds a run already or cannot be written.
    pub fn create(folder: &Path, scene: &Scene, simulator: &Simulator) -> Result<Self, SimulationError> {
        // A folder that another run writes to is said to be in use; one that holds anything else gets no lock
        // file.
        let held = folder.join(LOCK).exists().then(|| Lock::take(folder)).transpose()?;
        refuse_run(folder)?;
        let lock = held.map_or_else(|| Lock::take(folder), Ok)?;
        // Another run may have begun here in between.
        refuse_run(folder)?;
        Self::begin(folder, scene, simulator, lock)
    }

    fn begin(
        folder: &Path,
        scene: &Scene,
        simulator: &Simulator,
        mut lock: Lock,
    ) -> Result<Self, SimulationError> {
        remove_leftovers(folder, lock.sign()?);
        prepare(folder, scene)?;
        io::write_text(&folder.join("scene.toml"), &scene.to_toml())?;
        let path = folder.join("stats.jsonl");
        let statistics = File::create(&path).map_err(|source| IoError::system("create", &path, source))?;
        let writer = Self::new(folder, scene, simulator, statistics, lock)?;
        writer.write_frame(simulator)?;
        Ok(writer)
    }

    /// Continues the run of a folder: restores the simulator to its checkpoint, or to the one before it if
    /// that is damaged, and drops the statistics of later time steps, whose frames will be written again.
    ///
    /// # Errors
    /// A folder without a run, a run of another scene, a damaged checkpoint.
    pub fn resume(folder: &Path, scene: &Scene, simulator: &mut Simulator) -> Result<Self, SimulationError> {
        let fault = |message: String| SimulationError::Resume { path: folder.to_owned(), message };
        let path = folder.join("scene.toml");
        let was_begun = folder.join(LOCK).exists();
        if !path.exists() && !was_begun {
            return Err(fault(NO_RUN.to_owned()));
        }
        let mut lock = Lock::take(folder)?;
        if !path.exists() && refuse_run(folder).is_ok() {
            // A run that was killed before it wrote its scene.
            return Self::begin(folder, scene, simulator, lock);
        }
        remove_leftovers(folder, lock.sign()?);
        let text = fs::read_to_string(&path).map_err(|_| fault(NO_RUN.to_owned()))?;
        if let Some(differences) = differences(&text, &scene.to_toml()) {
            let message =
                format!("its scene differs in {differences}; only name, frames and output may change");
            return Err(fault(message));
        }
        warn_of_left_formats(&text, scene);
        let mut saved = Saved::new(folder);
        let checkpoint = saved.latest().map_err(|error| {
            fault(format!("{error}; without the folder checkpoint, the run is computed from its start"))
        })?;
        // A run that ended before its first checkpoint goes on from the start.
        if let Some(checkpoint) = checkpoint {
            simulator.restore(&checkpoint).map_err(|error| fault(error.to_string()))?;
        }
        prepare(folder, scene)?;
        io::write_text(&path, &scene.to_toml())?;

        let path = folder.join("stats.jsonl");
        let lines = fs::read_to_string(&path).unwrap_or_default();
        let kept: Vec<StepStatistics> = lines
            .lines()
            .map_while(|line| serde_json::from_str::<StepStatistics>(line).ok())
            .take_while(|statistics| statistics.step <= simulator.step_index())
            .collect();
        if kept.len() != simulator.step_index() {
            let steps = simulator.step_index();
            return Err(fault(format!(
                "stats.jsonl has {} of {}",
                kept.len(),
                counted(steps, "line", "lines")
            )));
        }
        let length: u64 = lines.split_inclusive('\n').take(kept.len()).map(|line| line.len() as u64).sum();
        let system = |source| IoError::system("write", &path, source);
        let statistics = OpenOptions::new().create(true).append(true).open(&path).map_err(system)?;
        statistics.set_len(length).map_err(system)?;

        let mut writer = Self::new(folder, scene, simulator, statistics, lock)?;
        writer.saved = saved;
        writer.statistics_length = length;
        kept.iter().for_each(|statistics| writer.totals.add(statistics));
        if simulator.step_index() == 0 {
            writer.write_frame(simulator)?;
        }
        writer.frames.restore(simulator.step_index() + 1)?;
        Ok(writer)
    }

    fn new(
        folder: &Path,
        scene: &Scene,
        simulator: &Simulator,
        statistics: File,
        lock: Lock,
    ) -> Result<Self, IoError> {
        let spool = folder.join("checkpoint").join("frames.f64");
        let width = scene.contact.delta;
        let layout = Layout::new(simulator.world());
        let dt = scene.simulation.dt;
        let asked = [scene.output.velocities, scene.output.contact_forces];
        let fields = Field::ALL.into_iter().zip(asked).filter(|(_, asked)| *asked);
        let fields = fields.map(|(field, _)| (field, folder.join(field_file(field)))).collect();
        let frames = FrameWriter::new(folder, &scene.output.formats, layout, spool, fields, dt, width)?;
        frames.write_surface(&frames.layout.with_corners(&simulator.world().positions, &[]))?;
        Ok(Self {
            folder: folder.to_owned(),
            checkpoint_every: scene.output.checkpoint_every,
            frames,
            recorder: Recorder::new(simulator),
            present: simulator.present().to_vec(),
            saved: Saved::new(folder),
            statistics,
            statistics_length: 0,
            totals: Totals::default(),
            _lock: lock,
        })
    }

    /// Writes the frame and the statistics of a time step, and a checkpoint if one is due.
    ///
    /// # Errors
    /// The system's refusal; what was written before stays whole.
    pub fn step(
        &mut self,
        statistics: &StepStatistics,
        simulator: &Simulator,
    ) -> Result<(), SimulationError> {
        if self.present != simulator.present() {
            self.recorder = Recorder::new(simulator);
            self.present = simulator.present().to_vec();
        }
        self.write_frame(simulator)?;
        self.append(statistics)?;
        self.totals.add(statistics);
        if self.checkpoint_every > 0 && simulator.step_index().is_multiple_of(self.checkpoint_every) {
            self.saved.write(&simulator.checkpoint())?;
        }
        Ok(())
    }

    /// Writes the checkpoint and what is written once: after the last time step, or when interrupted.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn finish(&mut self, simulator: &Simulator) -> Result<(), SimulationError> {
        self.saved.write(&simulator.checkpoint())?;
        Ok(self.frames.finish(simulator.step_index() + 1)?)
    }

    /// Records a collision problem in `states/`.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn write_problem(&self, problem: &CollisionProblem<'_>) -> Result<(), IoError> {
        let name = format!("states/{:06}_{:02}.npz", problem.step, problem.iteration);
        self.recorder.states(problem).write(&self.folder.join(name))
    }

    /// Writes a state to `trace/`; `l` is 0 for the start of a problem and l + 1 after two-way step l.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn write_trace(&self, step: usize, iteration: usize, l: usize, x: &[Point]) -> Result<(), IoError> {
        let path = self.folder.join(format!("trace/{step:06}_{iteration:02}_{l:05}.ply"));
        let layout = &self.frames.layout;
        write_ply(&path, &layout.view(&layout.with_corners(x, &self.present)))
    }

    /// What the statistics so far add up to.
    pub(super) fn totals(&self) -> &Totals {
        &self.totals
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn write_frame(&self, simulator: &Simulator) -> Result<(), IoError> {
        let positions = self.frames.layout.with_corners(simulator.positions(), &self.present);
        let fields: Vec<Vec<Vector>> =
            self.frames.fields().map(|field| self.values(simulator, field)).collect();
        self.frames.write(simulator.step_index(), &positions, &fields)
    }

    /// A field on the vertices of a frame: zeros on the corners of half-spaces.
    fn values(&self, simulator: &Simulator, field: Field) -> Vec<Vector> {
        let collide = simulator.world().collision_vertices();
        let mut values = match field {
            Field::Velocity => simulator.velocities()[..collide].to_vec(),
            Field::ContactForce => simulator.contact_forces(),
        };
        values.resize(self.frames.layout.vertices(), Vector::zeros());
        values
    }

    fn append(&mut self, statistics: &StepStatistics) -> Result<(), IoError> {
        let path = self.folder.join("stats.jsonl");
        let system = |source| IoError::system("write", &path, source);
        let mut line = serde_json::to_vec(statistics).map_err(|e| system(e.into()))?;
        line.push(b'\n');
        if let Err(source) = self.statistics.write_all(&line) {
            // Half a line would be no JSON; the first error is the one to report.
            let _ = self.statistics.set_len(self.statistics_length);
            return Err(system(source));
        }
        self.statistics_length += line.len() as u64;
        Ok(())
    }
}

/// Refuses a folder that holds a run. Empty folders are what a run leaves that was killed at its very
/// beginning.
///
/// # Errors
/// [`SimulationError::RunExists`].
pub fn refuse_run(folder: &Path) -> Result<(), SimulationError> {
    let holds = |part: &&str| {
        let path = folder.join(part);
        match fs::read_dir(&path) {
            Ok(entries) => entries.flatten().any(|entry| entry.path() != folder.join(LOCK)),
            Err(_) => path.exists(),
        }
    };
    match PARTS.iter().any(holds) {
        true => Err(SimulationError::RunExists { path: folder.to_owned() }),
        false => Ok(()),
    }
}

/// Removes the temporary files of a run that was killed. They have the number of its process in their names;
/// those of others may be in use.
fn remove_leftovers(folder: &Path, process: Option<u32>) {
    let Some(process) = process.filter(|&process| process != std::process::id()) else { return };
    let of_process = format!(".{process}-");
    for below in ["", "frames", "checkpoint", "pc2", "surface", "trace", "states"] {
        for entry in fs::read_dir(folder.join(below)).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') && name.contains(&of_process) && name.ends_with(".part") {
                // What cannot be removed is only in the way.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Creates the folders of a run.
fn prepare(folder: &Path, scene: &Scene) -> Result<(), IoError> {
    create_folder(&folder.join("frames"))?;
    create_folder(&folder.join("checkpoint"))?;
    if scene.output.trace {
        create_folder(&folder.join("trace"))?;
    }
    if scene.output.record {
        create_folder(&folder.join("states"))?;
    }
    if scene.output.velocities || scene.output.contact_forces {
        create_folder(&folder.join("fields"))?;
    }
    Ok(())
}
