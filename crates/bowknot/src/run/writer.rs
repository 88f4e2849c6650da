//! The output folder of a run.
//!
//! ```text
//! scene.toml                resolved scene
//! frames/000000.ply ..      one file a frame and format; frames.npz beside it for the format npz
//! stats.jsonl               one line a time step
//! summary.json              written at the end
//! checkpoint/state.npz      the state to resume from
//! trace/STEP_ITER_L.ply     every x^(l), if asked for; L = 0 is where the problem starts
//! states/STEP_ITER.npz      the collision problems, if asked for
//! ```
//!
//! Files are written under another name first, so a reader, or a run that dies, finds whole files only. A
//! time step writes its frame, then its line of statistics, then the checkpoint: all that a checkpoint
//! builds on is there.

use super::summary::Totals;
use crate::io::{self, FrameStack, Import, IoError, MeshView, States, create_folder, write_obj, write_ply};
use crate::scene::{Format, Scene};
use crate::simulator::{Checkpoint, CollisionProblem, SimulationError, Simulator, StepStatistics};
use crate::world::World;
use bowknot_geometry::{HalfSpace, Point, Vector};
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What tells that a folder holds a run.
const PARTS: [&str; 6] = ["scene.toml", "frames", "frames.npz", "stats.jsonl", "summary.json", "checkpoint"];

/// Writes the files of a run.
#[derive(Debug)]
pub struct RunWriter {
    folder: PathBuf,
    formats: Vec<Format>,
    checkpoint_every: usize,
    layout: Layout,
    masses: Vec<f64>,
    statistics: File,
    /// Length of `stats.jsonl` up to its last whole line [bytes].
    statistics_length: u64,
    stack: Option<FrameStack>,
    totals: Totals,
}

/// What is the same in all frames.
#[derive(Clone, Debug)]
struct Layout {
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    particles: Vec<u32>,
    quads: Vec<[u32; 4]>,
    /// Corners of the quads, which follow the world's vertices [m].
    corners: Vec<Point>,
    obstacle: Vec<bool>,
    body: Vec<u32>,
}

impl RunWriter {
    /// Begins a run in a folder, which is created, and writes the first frame.
    ///
    /// # Errors
    /// A folder that holds a run already or cannot be written.
    pub fn create(folder: &Path, scene: &Scene, simulator: &Simulator) -> Result<Self, SimulationError> {
        if PARTS.iter().any(|part| folder.join(part).exists()) {
            return Err(SimulationError::RunExists { path: folder.to_owned() });
        }
        prepare(folder, scene)?;
        io::write_text(&folder.join("scene.toml"), &scene.to_toml())?;
        let path = folder.join("stats.jsonl");
        let statistics = File::create(&path).map_err(|source| IoError::system("create", &path, source))?;
        let mut writer = Self::new(folder, scene, simulator, statistics);
        writer.write_frame(simulator)?;
        Ok(writer)
    }

    /// Continues the run of a folder: restores the simulator to its checkpoint and drops the statistics
    /// of later time steps, whose frames will be written again.
    ///
    /// # Errors
    /// A folder without a run, a run of another scene, a damaged checkpoint.
    pub fn resume(folder: &Path, scene: &Scene, simulator: &mut Simulator) -> Result<Self, SimulationError> {
        let fault = |message: String| SimulationError::Resume { path: folder.to_owned(), message };
        let path = folder.join("scene.toml");
        let text = fs::read_to_string(&path).map_err(|_| fault("it holds no run".to_owned()))?;
        if let Some(key) = first_difference(&text, &scene.to_toml()) {
            return Err(fault(format!("its scene differs in {key}; only frames and output may change")));
        }
        let checkpoint = checkpoint_path(folder);
        // A run that ended before its first checkpoint goes on from the start.
        if checkpoint.exists() {
            simulator.restore(&Checkpoint::read(&checkpoint)?).map_err(fault)?;
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
            return Err(fault(format!("stats.jsonl has {} of {steps} lines", kept.len())));
        }
        let length: u64 = lines.split_inclusive('\n').take(kept.len()).map(|line| line.len() as u64).sum();
        let system = |source| IoError::system("write", &path, source);
        let statistics = OpenOptions::new().create(true).append(true).open(&path).map_err(system)?;
        statistics.set_len(length).map_err(system)?;

        let mut writer = Self::new(folder, scene, simulator, statistics);
        writer.statistics_length = length;
        kept.iter().for_each(|statistics| writer.totals.add(statistics));
        if writer.stack.is_some() {
            let frames = simulator.step_index() + 1;
            let stack = writer.read_stack(frames)?;
            writer.stack = Some(stack);
        }
        if simulator.step_index() == 0 {
            writer.stack = writer.stack.map(|_| FrameStack::new(&writer.layout.view(&[]), &[]));
            writer.write_frame(simulator)?;
        }
        Ok(writer)
    }

    fn new(folder: &Path, scene: &Scene, simulator: &Simulator, statistics: File) -> Self {
        let layout = Layout::new(simulator.world());
        let stack = scene.output.formats.contains(&Format::Npz);
        Self {
            folder: folder.to_owned(),
            formats: scene.output.formats.clone(),
            checkpoint_every: scene.output.checkpoint_every,
            stack: stack.then(|| FrameStack::new(&layout.view(&[]), &[])),
            layout,
            masses: simulator.dynamics_model().masses().to_vec(),
            statistics,
            statistics_length: 0,
            totals: Totals::default(),
        }
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
        self.write_frame(simulator)?;
        self.append(statistics)?;
        self.totals.add(statistics);
        if self.checkpoint_every > 0 && simulator.step_index().is_multiple_of(self.checkpoint_every) {
            self.write_checkpoint(simulator)?;
        }
        Ok(())
    }

    /// Writes the checkpoint and what is written once: after the last time step, or when interrupted.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn finish(&mut self, simulator: &Simulator) -> Result<(), SimulationError> {
        self.write_checkpoint(simulator)?;
        self.write_stack()
    }

    /// Records a collision problem in `states/`.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn write_problem(&self, problem: &CollisionProblem<'_>, world: &World) -> Result<(), IoError> {
        let states = States {
            x: problem.positions.to_vec(),
            y: problem.target.to_vec(),
            triangles: self.layout.triangles.clone(),
            strands: self.layout.strands.clone(),
            particles: self.layout.particles.clone(),
            rest: world.positions.clone(),
            masses: self.masses.clone(),
            fixed: problem.prescribed.to_vec(),
            obstacle: self.layout.obstacle[..world.positions.len()].to_vec(),
            body: world.collision.vertex_body().to_vec(),
            half_spaces: world.collision.half_spaces().to_vec(),
            time_step: Some(problem.time_step),
        };
        states.write(&self.folder.join(format!("states/{:06}_{:02}.npz", problem.step, problem.iteration)))
    }

    /// Writes a state to `trace/`; `l` is 0 for the start of a problem and l + 1 after two-way step l.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn write_trace(&self, step: usize, iteration: usize, l: usize, x: &[Point]) -> Result<(), IoError> {
        let path = self.folder.join(format!("trace/{step:06}_{iteration:02}_{l:05}.ply"));
        write_ply(&path, &self.layout.view(&self.layout.with_corners(x)))
    }

    /// What the statistics so far add up to.
    pub(super) fn totals(&self) -> &Totals {
        &self.totals
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn frame_path(&self, frame: usize, ending: &str) -> PathBuf {
        self.folder.join(format!("frames/{frame:06}.{ending}"))
    }

    fn write_frame(&mut self, simulator: &Simulator) -> Result<(), SimulationError> {
        let positions = self.layout.with_corners(simulator.positions());
        let view = self.layout.view(&positions);
        let frame = simulator.step_index();
        for format in &self.formats {
            match format {
                Format::Ply => write_ply(&self.frame_path(frame, "ply"), &view)?,
                Format::Obj => write_obj(&self.frame_path(frame, "obj"), &view)?,
                Format::Npz => {}
            }
        }
        if let Some(stack) = &mut self.stack {
            // The stack was made for this layout, so the frame fits.
            let _ = stack.push(&positions);
        }
        Ok(())
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

    fn write_checkpoint(&self, simulator: &Simulator) -> Result<(), SimulationError> {
        // The stack is all that there is of the frames if no other format is written.
        if self.formats.iter().all(|format| *format == Format::Npz) {
            self.write_stack()?;
        }
        simulator.checkpoint().write(&checkpoint_path(&self.folder))?;
        Ok(())
    }

    fn write_stack(&self) -> Result<(), SimulationError> {
        if let Some(stack) = &self.stack {
            stack.write(&self.folder.join("frames.npz"))?;
        }
        Ok(())
    }

    /// The first `frames` frames, from `frames.npz` or from the frames of another format.
    fn read_stack(&self, frames: usize) -> Result<FrameStack, SimulationError> {
        let path = self.folder.join("frames.npz");
        if path.exists() {
            let mut stack = FrameStack::read(&path)?;
            if stack.len() >= frames {
                stack.truncate(frames);
                return Ok(stack);
            }
        }
        let mut stack = FrameStack::new(&self.layout.view(&[]), &[]);
        for frame in 0..frames {
            let ply = self.frame_path(frame, "ply");
            let path = if ply.exists() { ply } else { self.frame_path(frame, "obj") };
            let mesh = io::read_mesh(&path, &Import::default())?;
            if !stack.push(&mesh.positions) {
                let message = format!("{} has another number of vertices", path.display());
                return Err(SimulationError::Resume { path: self.folder.clone(), message });
            }
        }
        Ok(stack)
    }
}

impl Layout {
    fn new(world: &World) -> Self {
        let topology = world.collision.topology();
        let mut layout = Self {
            triangles: topology.triangles.clone(),
            strands: topology.strand_edges.iter().map(|&e| topology.edges[e as usize]).collect(),
            particles: topology.particles.clone(),
            quads: Vec::new(),
            corners: Vec::new(),
            obstacle: (0..topology.vertex_count as u32).map(|v| world.collision.is_obstacle(v)).collect(),
            body: world.collision.vertex_body().to_vec(),
        };
        let (low, high) = world.bounds();
        let center = nalgebra::center(&low, &high);
        // Wide enough that what happens in a run happens above it.
        let half_size = 2.0 * (high - low).norm().max(0.5);
        for (index, half_space) in world.collision.half_spaces().iter().enumerate() {
            let first = (world.positions.len() + layout.corners.len()) as u32;
            layout.quads.push([first, first + 1, first + 2, first + 3]);
            layout.corners.extend(quad(half_space, &center, half_size));
            layout.obstacle.extend([true; 4]);
            layout.body.extend([(world.bodies.len() + index) as u32; 4]);
        }
        layout
    }

    fn with_corners(&self, positions: &[Point]) -> Vec<Point> {
        [positions, &self.corners].concat()
    }

    fn view<'a>(&'a self, positions: &'a [Point]) -> MeshView<'a> {
        MeshView {
            positions,
            triangles: &self.triangles,
            quads: &self.quads,
            strands: &self.strands,
            particles: &self.particles,
            obstacle: &self.obstacle,
            body: &self.body,
        }
    }
}

/// A square of the plane around the foot of `center`, counter-clockwise seen from outside.
fn quad(half_space: &HalfSpace, center: &Point, half_size: f64) -> [Point; 4] {
    let n = half_space.normal;
    let foot = center - n * half_space.signed_distance(center);
    let axis = if n.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    let u = (axis - n * n.dot(&axis)).normalize() * half_size;
    let v = n.cross(&u);
    [foot - u - v, foot + u - v, foot + u + v, foot - u + v]
}

fn checkpoint_path(folder: &Path) -> PathBuf {
    folder.join("checkpoint").join("state.npz")
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
    Ok(())
}

/// The first key in which two resolved scenes differ, but for how long they run and what they write.
fn first_difference(a: &str, b: &str) -> Option<String> {
    fn differ(a: &toml::Value, b: &toml::Value, path: &str) -> Option<String> {
        match (a, b) {
            (toml::Value::Table(a), toml::Value::Table(b)) => {
                let missing = b.keys().find(|key| !a.contains_key(*key));
                a.iter()
                    .find_map(|(key, value)| {
                        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                        b.get(key).map_or(Some(path.clone()), |other| differ(value, other, &path))
                    })
                    .or_else(|| missing.map(|key| format!("{path}.{key}")))
            }
            (toml::Value::Array(a), toml::Value::Array(b)) if a.len() == b.len() => {
                a.iter().zip(b).enumerate().find_map(|(i, (a, b))| differ(a, b, &format!("{path}[{i}]")))
            }
            _ => (a != b).then(|| path.to_owned()),
        }
    }
    let parse = |text: &str| {
        let mut table: toml::Table = text.parse().ok()?;
        table.remove("output");
        if let Some(toml::Value::Table(simulation)) = table.get_mut("simulation") {
            simulation.remove("frames");
        }
        Some(toml::Value::Table(table))
    };
    match (parse(a), parse(b)) {
        (Some(a), Some(b)) => differ(&a, &b, ""),
        _ => Some("scene.toml, which is not TOML".to_owned()),
    }
}
