//! Whole runs: a scene in, a folder of frames and statistics out.

mod advice;
mod backends;
mod checker;
mod checkpoint;
mod differences;
mod export;
mod frames;
mod layout;
mod lock;
mod progress;
mod saved;
mod spool;
mod summary;
mod watch;
mod writer;

pub use advice::{Remedy, UnsolvedAdvice, residual_text};
pub use backends::{BackendRecord, Backends};
pub use checker::Checker;
pub use export::{ExportError, ExportOptions, Exported, Rate, export};
pub use progress::{Progress, WithinStep};
pub use summary::{
    EnergyNumbers, HeldApartStep, SecondsNumbers, SkippedNumbers, SlowStep, StepNumbers, Summary,
    UnsolvedStep, WaitToAppear,
};
pub use watch::{FailureWatch, SmallestState};
pub use writer::{RunWriter, refuse_run};

use crate::simulator::{
    AcceptedStep, CollisionProblem, SimulationError, SimulationObserver, Simulator, WaitingElements,
    peak_memory_bytes,
};
use bowknot_io::{IoError, write_text};
use bowknot_scene::Scene;
use bowknot_scene::world::World;
use progress::Reporter;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::panic::{self, AssertUnwindSafe};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How a scene is run; what is written is said by the scene's [`bowknot_scene::OutputParams`].
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Output folder.
    pub out: PathBuf,
    /// Whether to continue the run that the folder holds. `scene.simulation.frames` counts from the
    /// start, not from the checkpoint.
    pub resume: bool,
    /// Whether the path to every accepted state is judged, and the state that each time step ends with;
    /// see [`Checker`] for why no accepted state can then intersect.
    pub check: bool,
    /// When this becomes true the run stops as soon as it can, even within a time step, which is then
    /// abandoned.
    pub interrupt: Option<Arc<AtomicBool>>,
    /// Keeps what shows a failure of the run. Copies each collision problem in memory.
    pub watch: Option<FailureWatch>,
}

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The content of `summary.json`.
    pub summary: Summary,
    /// Whether it was stopped before its last frame; the checkpoint is valid.
    pub interrupted: bool,
    /// The first intersections found, in words; empty if not checked.
    pub findings: Vec<String>,
    /// What was repaired or left out of the scene's meshes, in words.
    pub warnings: Vec<String>,
}

/// Runs a scene to its last frame on the CPU. `progress` is called before the first time step and after each,
/// and every second within one that takes longer than two; `Break` ends the run there, and abandons a time
/// step that is not done.
///
/// # Errors
/// Whatever [`Simulator::new`] and [`Simulator::step`] refuse; a folder that cannot be written, holds a run
/// already, is in use by another run, or cannot be resumed. A panic of any thread, `progress` included, is
/// [`SimulationError::Internal`]. Frames written so far stay.
pub fn run(
    scene: &Scene,
    options: &RunOptions,
    progress: &mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>,
) -> Result<Outcome, SimulationError> {
    run_on(scene, options, Backends::default(), progress)
}

/// As [`run`], with backends for the collisions and for the dynamics. [`BackendRecord::read`] tells
/// which ones computed a folder so far: a resumption has the same bits with them only.
///
/// # Errors
/// As [`run`]; [`SimulationError::Backend`] if a backend does not have what the scene needs, or fails. The
/// checkpoint then holds the last state before it failed.
pub fn run_on(
    scene: &Scene,
    options: &RunOptions,
    backends: Backends,
    progress: &mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>,
) -> Result<Outcome, SimulationError> {
    let step = Cell::new(0);
    // What a panic leaves behind in memory is dropped, and files are written as a whole or not at all.
    panic::catch_unwind(AssertUnwindSafe(|| run_steps(scene, options, backends, progress, &step)))
        .unwrap_or_else(|panic| {
            let message = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let message = message.or_else(|| panic.downcast_ref::<String>().cloned());
            let message = message.unwrap_or_else(|| "a panic without a message".to_owned());
            Err(SimulationError::Internal { step: step.get(), message })
        })
}

/// The run itself; `present` is the time step that it is at, from 1.
fn run_steps(
    scene: &Scene,
    options: &RunOptions,
    backends: Backends,
    progress: &mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>,
    present: &Cell<usize>,
) -> Result<Outcome, SimulationError> {
    let mut simulator = Simulator::new(scene)?;
    let record = backends.record();
    simulator.set_backend(backends.collisions)?;
    simulator.set_dynamics_backend(backends.dynamics)?;
    simulator.check_motions(scene.simulation.frames)?;
    let mut writer = if options.resume {
        RunWriter::resume(&options.out, scene, &mut simulator)?
    } else {
        RunWriter::create(&options.out, scene, &simulator)?
    };
    record.write(writer.folder())?;
    let info = simulator.world().info(scene.simulation.dt);
    let world = Arc::clone(simulator.world());
    let mut checker = options.check.then(|| Checker::new(&simulator));
    if let Some(watch) = &options.watch {
        watch.begin(&simulator);
    }
    let mut there = simulator.present().to_vec();
    let frames = scene.simulation.frames;
    let near_starts = simulator.near_starts();
    let mut reporter = Reporter::new(progress, frames, &world, &info, &near_starts);

    let stop_asked = || options.interrupt.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed));
    let mut interrupted = reporter.between_steps(simulator.step_index(), None, checker.as_ref()).is_break();
    while !interrupted && simulator.step_index() < frames {
        present.set(simulator.step_index() + 1);
        let mut observer = RunObserver {
            writer: &writer,
            checker: checker.as_mut(),
            watch: options.watch.as_ref(),
            world: &world,
            trace: scene.output.trace,
            record: scene.output.record,
            stop_asked: &stop_asked,
            reporter: &mut reporter,
            error: None,
        };
        let result = simulator.step_observed(&mut observer);
        if let Some(error) = observer.error {
            return Err(error);
        }
        match result {
            Ok(statistics) => {
                if let Some(checker) = &mut checker {
                    let positions = &simulator.positions()[..world.collision_vertices()];
                    let before = checker.intersections();
                    checker.judge_end(statistics.step, positions, &world)?;
                    if let Some(watch) = options.watch.as_ref().filter(|_| checker.intersections() > before) {
                        watch.found_intersection(positions);
                    }
                }
                if let Some(watch) = options.watch.as_ref().filter(|_| !statistics.converged) {
                    watch.not_converged();
                }
                if let Some(checker) = &mut checker {
                    checker.follow(&simulator);
                }
                if let Some(watch) = options.watch.as_ref().filter(|_| there != simulator.present()) {
                    watch.begin(&simulator);
                }
                there = simulator.present().to_vec();
                writer.step(&statistics, &simulator)?;
                let step = simulator.step_index();
                interrupted = reporter.between_steps(step, Some(&statistics), checker.as_ref()).is_break();
            }
            Err(SimulationError::Interrupted) => interrupted = true,
            Err(error @ SimulationError::Backend { .. }) => {
                writer.finish(&simulator)?;
                return Err(error);
            }
            Err(error) => return Err(error),
        }
        interrupted |= stop_asked();
    }
    interrupted &= simulator.step_index() < frames;
    writer.finish(&simulator)?;

    let totals = writer.totals();
    let path = writer.folder().join("summary.json");
    let unwritable = |error: serde_json::Error| IoError::system("write", &path, error.into());
    let summary = Summary {
        scene: scene.name().to_owned(),
        info,
        frames: totals.steps(),
        threads: rayon::current_num_threads(),
        backend: record.collisions,
        dynamics_backend: record.dynamics,
        mean: totals.mean().map_err(unwritable)?,
        max: totals.max().map_err(unwritable)?,
        min_gap_m: totals.min_gap(),
        slowest_step: totals.slowest().cloned(),
        unsolved_steps: totals.unsolved_steps(),
        first_unsolved: totals.first_unsolved().cloned(),
        waits_to_appear: totals.waits_to_appear().clone(),
        held_apart_steps: totals.held_apart_steps(),
        most_held_apart: totals.most_held_apart().cloned(),
        peak_memory_bytes: peak_memory_bytes(),
        intersections: checker.as_ref().map(Checker::intersections),
    };
    let text = serde_json::to_string_pretty(&summary).map_err(unwritable)?;
    write_text(&path, &(text + "\n"))?;
    let findings = checker.map_or_else(Vec::new, |checker| checker.findings().to_vec());
    Ok(Outcome { summary, interrupted, findings, warnings: world.warnings.clone() })
}

/// What happens within the time steps of a run.
struct RunObserver<'a, 'p> {
    writer: &'a RunWriter,
    checker: Option<&'a mut Checker>,
    watch: Option<&'a FailureWatch>,
    world: &'a World,
    trace: bool,
    record: bool,
    stop_asked: &'a dyn Fn() -> bool,
    reporter: &'a mut Reporter<'p>,
    error: Option<SimulationError>,
}

impl RunObserver<'_, '_> {
    fn go_on(&mut self, result: Result<(), SimulationError>) -> ControlFlow<()> {
        match result {
            Ok(()) if (self.stop_asked)() => ControlFlow::Break(()),
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.error = Some(error);
                ControlFlow::Break(())
            }
        }
    }
}

impl SimulationObserver for RunObserver<'_, '_> {
    fn problem(&mut self, problem: &CollisionProblem<'_>) -> ControlFlow<()> {
        if let Some(watch) = self.watch {
            watch.problem(problem);
        }
        let write = || -> Result<(), SimulationError> {
            if self.record {
                self.writer.write_problem(problem)?;
            }
            if self.trace {
                self.writer.write_trace(problem.step, problem.iteration, 0, problem.positions)?;
            }
            Ok(())
        };
        let result = write();
        self.go_on(result)
    }

    fn accepted(&mut self, accepted: &AcceptedStep<'_>) -> ControlFlow<()> {
        let mut handle = || -> Result<(), SimulationError> {
            if self.trace {
                let l = accepted.state.step + 1;
                self.writer.write_trace(accepted.step, accepted.iteration, l, accepted.state.positions)?;
            }
            if let Some(checker) = &mut self.checker {
                let before = checker.intersections();
                checker.judge(accepted, self.world)?;
                if let Some(watch) = self.watch.filter(|_| checker.intersections() > before) {
                    watch.found_intersection(accepted.state.positions);
                }
            }
            Ok(())
        };
        let result = handle();
        match self.reporter.advanced(1) {
            ControlFlow::Continue(()) => self.go_on(result),
            stop => stop,
        }
    }

    fn sees_each_state(&self) -> bool {
        self.trace || self.checker.is_some()
    }

    fn advanced(&mut self, steps: usize) -> ControlFlow<()> {
        match self.reporter.advanced(steps) {
            ControlFlow::Continue(()) => self.go_on(Ok(())),
            stop => stop,
        }
    }

    fn waiting(&mut self, tell: &dyn Fn() -> Vec<WaitingElements>) {
        self.reporter.waiting(tell, self.checker.as_deref());
    }
}
