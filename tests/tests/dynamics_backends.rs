//! Whole simulations with the dynamics on the twins of the kernels: they go as on the CPU.
//!
//! Where bodies crumple, differences of the size of a tolerance grow. The yardstick for them are runs on the
//! CPU with more accurate linear solves and with another preconditioner, which should make no difference
//! either.
//!
//! `--ignored` counts iterations in larger scenes and prints a table; see `docs/gpu/dynamics.md`.

use bowknot::dynamics::{
    AssemblySprings, ElementModel, Matrix3, NewtonBackend, NewtonBackendError, NewtonSolve, NewtonStep,
    NewtonTarget, OutOfBalance, SolveLimits, Trial, Watched,
};
use bowknot::geometry::{Point, Vector};
use bowknot::gpu::{Adapter, ComparingEngine, ConjugateGradients, DeviceEngine, Engine, TwinEngine};
use bowknot::run::{self, Backends, Progress, RunOptions};
use bowknot::{Scene, SimulationError, Simulator};
use std::fmt::Debug;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex};

/// A scene, its scale, assignments to its keys, and the number of time steps.
type Case = (&'static str, f64, &'static [&'static str], usize);

/// Cloth, a jelly on a trampoline, strands.
const SMALL: [Case; 3] = [
    ("drape", 0.25, &["body.0.velocity=[0,0,-4]"], 16),
    ("trampoline", 0.2, &[], 40),
    ("hair", 0.05, &[], 10),
];

const OTHERS: [&str; 4] = [
    "solver.newton.cg_tolerance=5e-5",
    "solver.newton.cg_tolerance=1e-5",
    "solver.newton.cg_tolerance=1e-6",
    "solver.newton.preconditioner=\"block-jacobi\"",
];

/// What the solves of a run were.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    systems: usize,
    rounds: usize,
    iterations: usize,
    differences: usize,
    /// Newton iterations: matrices that linear systems were solved for.
    solved: usize,
}

/// An engine that says how many words of it differ from those of the twins.
trait Comparing: Engine + Debug + Send {
    fn differences(&self) -> usize {
        0
    }
}

impl Comparing for TwinEngine {}

impl Comparing for ComparingEngine {
    fn differences(&self) -> usize {
        self.differences().len()
    }
}

/// Newton iterations on an engine, counted.
#[derive(Debug)]
struct Counted<E> {
    inner: ConjugateGradients<E>,
    counts: Arc<Mutex<Counts>>,
    fails_at: Option<usize>,
}

impl<E: Comparing> Counted<E> {
    fn new(engine: E, fails_at: Option<usize>) -> (Box<Self>, Arc<Mutex<Counts>>) {
        let counts: Arc<Mutex<Counts>> = Arc::default();
        let inner = ConjugateGradients::new("twins".to_owned(), engine);
        (Box::new(Self { inner, counts: Arc::clone(&counts), fails_at }), counts)
    }

    /// Counts a matrix. Fails if it is time to.
    fn count_system(&self) -> Result<(), NewtonBackendError> {
        let mut counts = self.counts.lock().expect("no panic");
        counts.systems += 1;
        if self.fails_at == Some(counts.systems) { Err("the device was lost".into()) } else { Ok(()) }
    }
}

impl<E: Comparing> Counted<E> {
    /// Notes how many words differ so far.
    fn note_differences(&self) {
        let mut counts = self.counts.lock().expect("no panic");
        counts.differences = self.inner.engine().differences();
    }
}

impl<E: Comparing> NewtonBackend for Counted<E> {
    fn name(&self) -> String {
        self.inner.name()
    }

    fn set_model(&mut self, model: &ElementModel) -> Result<(), NewtonBackendError> {
        self.inner.set_model(model)
    }

    fn begin_step(&mut self, step: &NewtonStep<'_>) -> Result<(), NewtonBackendError> {
        self.inner.begin_step(step)
    }

    fn begin_target(&mut self, target: &NewtonTarget<'_>) -> Result<Watched, NewtonBackendError> {
        self.inner.begin_target(target)
    }

    fn linearize(&mut self, absolute: bool) -> Result<(), NewtonBackendError> {
        self.count_system()?;
        self.inner.linearize(absolute)
    }

    fn diagonal(&mut self, blocks: &mut Vec<Matrix3<f64>>) -> Result<(), NewtonBackendError> {
        self.inner.diagonal(blocks)
    }

    fn solve(
        &mut self,
        springs: &AssemblySprings<'_>,
        limits: &SolveLimits,
    ) -> Result<NewtonSolve, NewtonBackendError> {
        let solved = self.inner.solve(springs, limits)?;
        let mut counts = self.counts.lock().expect("no panic");
        counts.solved += 1;
        counts.rounds += 1;
        counts.iterations += solved.info.iterations;
        Ok(solved)
    }

    fn component_residuals(&mut self, sums: &mut Vec<Vector>) -> Result<(), NewtonBackendError> {
        self.inner.component_residuals(sums)
    }

    fn translate(&mut self, translations: &[Vector]) -> Result<(), NewtonBackendError> {
        self.inner.translate(translations)
    }

    fn place(&mut self, length: f64) -> Result<Trial, NewtonBackendError> {
        self.inner.place(length)
    }

    fn begin_search(&mut self) -> Result<(Watched, Trial), NewtonBackendError> {
        self.inner.begin_search()
    }

    fn start_from_trial(&mut self) -> Result<(), NewtonBackendError> {
        self.inner.start_from_trial()
    }

    fn keep_trial(&mut self) -> Result<(), NewtonBackendError> {
        self.inner.keep_trial()
    }

    fn start_from_kept_trial(&mut self) -> Result<(), NewtonBackendError> {
        self.inner.start_from_kept_trial()
    }

    fn target(&mut self, y: &mut [Vector]) -> Result<(), NewtonBackendError> {
        self.inner.target(y)?;
        self.note_differences();
        Ok(())
    }

    fn out_of_balance(
        &mut self,
        springs: &AssemblySprings<'_>,
        known: &[Vector],
        counted: &[bool],
        absolute: bool,
    ) -> Result<OutOfBalance, NewtonBackendError> {
        self.count_system()?;
        self.inner.out_of_balance(springs, known, counted, absolute)
    }
}

#[derive(Debug)]
struct Course {
    edge: f64,
    centers: Vec<Point>,
    newton_iterations: usize,
    converged: usize,
    /// First time step with contact rows.
    first_contact: usize,
    /// Of the backend, if there was one.
    counts: Counts,
}

fn simulator((name, scale, sets, _): Case, more: &[&str]) -> Simulator {
    let sets: Vec<String> = sets.iter().chain(more).map(|set| (*set).to_owned()).collect();
    let scene = Scene::builtin(name, scale).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    Simulator::new(&scene).expect("a simulator")
}

fn course(case: Case, more: &[&str], on_twins: bool) -> Course {
    let mut simulator = simulator(case, more);
    let (backend, counts) = Counted::new(TwinEngine::new(), None);
    if on_twins {
        simulator.set_dynamics_backend(Some(backend)).expect("linear elements");
    }
    let steps: Vec<_> = (0..case.3).map(|_| simulator.step().expect("a step")).collect();
    let counts = *counts.lock().expect("no panic");
    Course {
        edge: simulator.resolver().scene().lengths().edge,
        centers: steps.iter().map(|s| Point::from(s.center_of_mass)).collect(),
        newton_iterations: steps.iter().map(|s| s.newton_iterations).sum(),
        converged: steps.iter().filter(|s| s.converged).count(),
        first_contact: steps.iter().position(|s| s.contact_rows + s.pressing_contacts > 0).unwrap_or(case.3),
        counts,
    }
}

/// Largest distance of the centers of mass in the first `steps` time steps [m].
fn apart(a: &Course, b: &Course, steps: usize) -> f64 {
    a.centers.iter().zip(&b.centers).take(steps).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn runs_on_the_kernels_go_as_on_the_cpu() {
    for case in SMALL {
        let cpu = course(case, &[], false);
        let others = OTHERS.map(|set| course(case, &[set], false));
        let most = |steps: usize| others.iter().map(|other| apart(&cpu, other, steps)).fold(0.0, f64::max);
        // Two solutions of a time step may differ by the tolerance of the stopping rule each.
        let tolerance = 0.02 * cpu.edge;
        assert!(cpu.first_contact < case.3, "{}: the scene has not come to its contacts", case.0);
        let twins = course(case, &[], true);
        for steps in [cpu.first_contact, case.3] {
            let (found, own) = (apart(&cpu, &twins, steps), most(steps));
            assert!(
                found < 1.5 * own + tolerance,
                "{}, step {steps}: {found} m, the yardstick is {own} m",
                case.0
            );
        }
        assert_eq!((cpu.converged, twins.converged), (case.3, case.3), "{}", case.0);
        let ratio = twins.newton_iterations as f64 / cpu.newton_iterations as f64;
        assert!((0.8..1.25).contains(&ratio), "{}: {ratio} times the Newton iterations", case.0);
        let Counts { systems, rounds, .. } = twins.counts;
        assert!(systems > 0 && rounds > 0, "{}: {:?}", case.0, twins.counts);
    }
}

#[test]
fn a_lost_device_ends_a_step_that_can_be_made_again() {
    let case = SMALL[0];
    let [mut lost, mut whole] = [(); 2].map(|()| simulator(case, &[]));
    lost.set_dynamics_backend(Some(Counted::new(TwinEngine::new(), Some(4)).0)).expect("linear elements");
    let mut error = None;
    for _ in 0..case.3 {
        let before = lost.positions().to_vec();
        if let Err(found) = lost.step() {
            assert!(before == lost.positions(), "a failed step has moved something");
            error = Some(found);
            break;
        }
        whole.restore(&lost.checkpoint()).expect("the same scene");
    }
    let error = error.expect("the device was lost");
    assert!(matches!(error, SimulationError::Backend { .. }), "{error:?}");
    assert!(error.to_string().contains("the device was lost"), "{error}");
    lost.set_dynamics_backend(None).expect("the CPU");
    lost.step().expect("a step on the CPU");
    whole.step().expect("a step on the CPU");
    assert!(lost.positions() == whole.positions());
}

#[test]
fn a_matrix_that_is_too_large_for_a_device_ends_a_run_that_goes_on_on_the_cpu() {
    let folder = tempfile::tempdir().expect("a folder");
    let (name, scale, _, _) = SMALL[0];
    let scene = Scene::builtin(name, scale).and_then(|scene| scene.with_sets(&["simulation.frames=3"]));
    let scene = scene.expect("a scene");
    let options = |resume| RunOptions { out: folder.path().to_owned(), resume, ..RunOptions::default() };
    let mut go_on = |_: &Progress<'_>| ControlFlow::Continue(());
    let adapter = Adapter::choose(None).expect("a device, of software if need be");
    let mut engine = DeviceEngine::open(&adapter).expect("it opens");
    engine.limit_buffers(40_000);
    let linear = ConjugateGradients::new("limited".to_owned(), engine);
    let backends = Backends { dynamics: Some(Box::new(linear)), ..Backends::default() };
    let error = run::run_on(&scene, &options(false), backends, &mut go_on).expect_err("it is too large");
    assert!(matches!(error, SimulationError::Backend { step: 1, .. }), "{error:?}");
    let text = error.to_string();
    assert!(
        ["the matrix takes", "binds 40000 at most", "or the CPU"].iter().all(|part| text.contains(part)),
        "{text}"
    );
    let outcome = run::run(&scene, &options(true), &mut go_on).expect("it goes on");
    assert_eq!((outcome.summary.frames, outcome.summary.dynamics_backend.as_str()), (3, "cpu"));
}

#[test]
fn kernels_solve_the_systems_of_scenes_as_their_twins() {
    for case in SMALL {
        let mut simulator = simulator(case, &[]);
        // In contact: stress of what is at rest would be rounding, which differs.
        for _ in 0..case.3 {
            simulator.step().expect("a step");
        }
        let adapter = Adapter::choose(None).expect("a device, of software if need be");
        let engine = ComparingEngine::new(DeviceEngine::open(&adapter).expect("it opens"));
        let (backend, counts) = Counted::new(engine, None);
        simulator.set_dynamics_backend(Some(backend)).expect("linear elements");
        for _ in 0..3 {
            simulator.step().expect("a step");
        }
        let counts = *counts.lock().expect("no panic");
        assert!(counts.iterations > 0 && counts.differences == 0, "{}: {counts:?}", case.0);
    }
}

#[test]
fn a_resumed_run_has_the_same_bits() {
    let case = SMALL[0];
    let [mut whole, mut resumed] = [(); 2].map(|()| simulator(case, &[]));
    for simulator in [&mut whole, &mut resumed] {
        simulator
            .set_dynamics_backend(Some(Counted::new(TwinEngine::new(), None).0))
            .expect("linear elements");
    }
    for step in 0..10 {
        whole.step().expect("a step");
        if step == 4 {
            resumed.restore(&whole.checkpoint()).expect("the same scene");
        } else if step > 4 {
            resumed.step().expect("a step");
        }
    }
    assert!(whole.positions() == resumed.positions());
}

/// A block that comes to rest and sleeps, and a sheet that falls all the time.
const SLEEPER: &str = r#"
[solver.sleep]
enabled = true
time = 0.1
[[body]]
name = "block"
kind = "solid"
friction = 0.5
shape = { type = "block", size = [0.1, 0.1, 0.1], edge = 0.05 }
translate = [0, 0, 0.052]
[[body]]
name = "sheet"
shape = { type = "sheet", size = [0.2, 0.2], edge = 0.05 }
translate = [3, 0, 90]
[[obstacle]]
name = "ground"
shape = { type = "half-space" }
friction = 0.5
"#;

#[test]
fn solves_stay_on_the_device_while_bodies_sleep_and_after() {
    let scene = Scene::from_toml(SLEEPER, std::path::Path::new(".")).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let (backend, counts) = Counted::new(TwinEngine::new(), None);
    simulator.set_dynamics_backend(Some(backend)).expect("linear elements");
    let systems = || counts.lock().expect("no panic").systems;
    let step = |simulator: &mut Simulator| {
        let before = systems();
        simulator.step().expect("a step");
        assert!(systems() > before, "the CPU has solved alone");
        simulator.asleep().contains(&true)
    };
    let slept = (0..200).any(|_| step(&mut simulator));
    assert!(slept && step(&mut simulator), "the block does not sleep");
    assert_eq!(simulator.dynamics_backend().map(NewtonBackend::name).as_deref(), Some("twins"));
    let force = vec![Vector::z() * 0.2; simulator.positions().len()];
    simulator.set_external_forces(&force).expect("finite");
    assert!((0..5).any(|_| !step(&mut simulator)), "the block does not wake");
    step(&mut simulator);
}

#[test]
fn bodies_with_quadratic_elements_stay_on_the_cpu() {
    let text = RESTING_BLOCK.replace("kind = \"solid\"", "kind = \"solid\"\nelements = \"quadratic\"");
    let scene = Scene::from_toml(&text, std::path::Path::new(".")).expect("a scene");
    let run = |asks: bool| {
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        assert_eq!(
            simulator.world().bodies_only_on_cpu().map(|(name, _)| name).collect::<Vec<_>>(),
            ["block"]
        );
        if asks {
            let backend = Counted::new(TwinEngine::new(), None).0;
            let error = simulator.set_dynamics_backend(Some(backend)).expect_err("it is refused");
            assert!(matches!(error, SimulationError::Backend { .. }), "{error:?}");
            let text = error.to_string();
            assert!(text.contains("\"block\"") && text.contains("elements = \"linear\""), "{text}");
            assert!(simulator.dynamics_backend().is_none());
        }
        (0..3).for_each(|_| drop(simulator.step().expect("a step")));
        simulator.positions().to_vec()
    };
    assert!(run(true) == run(false));
}

/// Forces in single precision have a noise, which must neither drive what rests nor slow down what swings.
#[test]
fn a_sheet_swings_and_a_block_rests_as_on_the_cpu() {
    let energies = |text: &str, steps: usize, on_twins: bool| -> Vec<(f64, f64)> {
        let scene = Scene::from_toml(text, std::path::Path::new(".")).expect("a scene");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        if on_twins {
            simulator
                .set_dynamics_backend(Some(Counted::new(TwinEngine::new(), None).0))
                .expect("linear elements");
        }
        let mut step = || simulator.step().expect("a step");
        (0..steps).map(|_| step()).map(|s| (s.energy.kinetic, s.max_speed)).collect()
    };
    let [cpu, twins] = [false, true].map(|on_twins| energies(SWINGING_SHEET, 75, on_twins));
    let largest = cpu.iter().map(|(kinetic, _)| *kinetic).fold(0.0, f64::max);
    for (step, (expected, found)) in cpu.iter().zip(&twins).enumerate() {
        let apart = (found.0 - expected.0).abs();
        assert!(apart < 0.01 * largest, "step {step}: {apart:e} J of {largest:e}");
    }
    // A quantum of the grid per time step is 1e-7 m/s.
    let speed = energies(RESTING_BLOCK, 60, true)[59].1;
    assert!(speed < 5e-6, "{speed:e} m/s");
}

/// A sheet on the ground, and one that swings from two pins.
const SWINGING_SHEET: &str = r#"
[solver.sleep]
enabled = false
[[body]]
name = "sheet"
friction = 0.4
shape = { type = "sheet", size = [0.4, 0.4], edge = 0.02 }
translate = [0, 0, 0.01]
[[body]]
name = "hung"
shape = { type = "sheet", size = [0.3, 0.3], edge = 0.02 }
translate = [2, 0, 1]
[[pin]]
body = "hung"
box = { min = [1.8, -0.16, 0.9], max = [2.2, -0.14, 1.1] }
[[obstacle]]
name = "ground"
shape = { type = "half-space" }
friction = 0.4
"#;

/// A block on the ground.
const RESTING_BLOCK: &str = r#"
[solver.sleep]
enabled = false
[[body]]
name = "block"
kind = "solid"
friction = 0.5
shape = { type = "block", size = [0.1, 0.1, 0.1], edge = 0.025 }
translate = [0, 0, 0.052]
[[obstacle]]
name = "ground"
shape = { type = "half-space" }
friction = 0.5
"#;
