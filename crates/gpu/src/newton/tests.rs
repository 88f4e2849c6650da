//! Each function of the backend beside double precision on the twins, and kernels beside their twins.

mod fixture;
mod preconditioner;
mod solves;
mod sums;
mod trials;

use super::rounds::FIRST_BATCH;
use crate::adapter::Adapter;
use crate::engine::{ComparingEngine, DeviceEngine, Engine, TwinEngine};
use crate::error::GpuError;
use crate::linear::ConjugateGradients;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{AssemblySprings, ElementModel, NewtonBackend, NewtonStep, NewtonTarget, SolveLimits};
use bowknot_geometry::Vector;
use fixture::{Fixture, LIMITS, fixtures, read, solver};
use nalgebra::{DVector, Matrix3};
use std::fmt::Debug;

/// Rounding of a number in single precision.
const UNIT: f64 = 0.5 * f32::EPSILON as f64;

fn device() -> DeviceEngine {
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    DeviceEngine::open(&adapter).unwrap_or_else(|error| panic!("{error}"))
}

fn largest(a: &DVector<f64>) -> f64 {
    a.amax()
}

/// All calls once, as a Newton iteration makes them. Returns the end and what was told on the way.
///
/// The second target begins where the first has ended, or `returns`: near equilibrium forces are differences
/// of large ones, so that kernels and twins agree by less.
fn run<E: Engine + Debug + Send>(
    fixture: &Fixture,
    solver: &mut ConjugateGradients<E>,
    returns: bool,
) -> (Vec<Vector>, String) {
    let mut log = String::new();
    let mut y = fixture.begin(solver);
    let counted = vec![true; y.len()];
    let known = vec![Vector::new(1e-3, 0.0, 2e-3); y.len()];
    for round in 0..2 {
        let mut blocks = Vec::new();
        solver.linearize(round == 0).expect("runs");
        solver.diagonal(&mut blocks).expect("runs");
        let limits = SolveLimits { tolerance: 1e-3, ..LIMITS };
        let solved = solver.solve(&fixture.springs(), &limits).expect("runs");
        let mut sums = Vec::new();
        solver.component_residuals(&mut sums).expect("runs");
        solver
            .translate(&sums.iter().map(|_| Vector::new(1e-4, 0.0, 1e-5)).collect::<Vec<_>>())
            .expect("runs");
        let trials = [0.0, 1.0].map(|length| solver.place(length).expect("runs"));
        solver.start_from_trial().expect("runs");
        solver.target(&mut y).expect("runs");
        log += &format!("{blocks:?} {solved:?} {sums:?} {trials:?}");
        fixture.begin_target(solver, if returns { &fixture.iterate } else { &y });
    }
    let balance = solver.out_of_balance(&fixture.springs(), &known, &counted, true);
    log += &format!("{:?}", balance.expect("runs"));
    (y, log)
}

#[test]
fn every_kernel_computes_what_its_twin_computes() {
    for fixture in fixtures() {
        let mut solver = solver(ComparingEngine::new(device()), &fixture);
        run(&fixture, &mut solver, true);
        let engine = solver.engine();
        let faults = engine.faults();
        assert!(faults.is_empty(), "{}: {} {:?}", fixture.name, faults.len(), &faults[..1]);
        assert!(engine.words_compared() > 10_000);
    }
}

#[test]
fn two_runs_have_the_same_bits() {
    for fixture in fixtures() {
        let twins = [(); 2].map(|()| run(&fixture, &mut solver(TwinEngine::new(), &fixture), false));
        let devices = [(); 2].map(|()| run(&fixture, &mut solver(device(), &fixture), false));
        assert!(twins[0] == twins[1] && devices[0] == devices[1], "{}", fixture.name);
        let way = |k: usize| (twins[0].0[k] - devices[0].0[k]).norm();
        let apart = (0..twins[0].0.len()).map(way).fold(0.0, f64::max);
        println!("{}: twins and device are {apart:.1e} m apart", fixture.name);
        assert!(apart < 1e-5, "{}: {apart:e}", fixture.name);
    }
}

/// Without free nodes, without nodes, and with numbers that are not finite, calls come to an end.
#[test]
fn there_may_be_nothing_to_move() {
    for mut fixture in fixtures() {
        fixture.free.fill(false);
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        solver.linearize(false).expect("runs");
        let solved = solver.solve(&fixture.springs(), &LIMITS).expect("runs");
        assert!(solved.info.converged && solved.info.iterations == 0 && solved.scale == 0.0);
        let trial = solver.place(1.0).expect("runs");
        assert!((0..x.len()).all(|n| (trial.watched[n] - x[n] - fixture.imposed[n]).amax() < 1e-8));
    }
    let empty = ElementModel { starts: vec![0], scalar_starts: vec![0], ..ElementModel::default() };
    let mut without = ConjugateGradients::new("empty".to_owned(), device());
    without.set_model(&empty).expect("room");
    let step = NewtonStep {
        start: &[],
        inertial: &[],
        rate: 50.0,
        row_sums: &[],
        gradient: &[],
        bending: &[],
        scalars: &[],
    };
    without.begin_step(&step).expect("runs");
    let target = NewtonTarget { iterate: &[], free: &[], imposed: &[], watched: &[] };
    without.begin_target(&target).expect("runs");
    without.linearize(true).expect("runs");
    assert!(without.solve(&AssemblySprings::default(), &LIMITS).expect("runs").info.converged);
    assert_eq!(without.place(1.0).expect("runs").change, 0.0);

    let mut fixture = fixtures().swap_remove(1);
    fixture.iterate[20].x = f64::NAN;
    let mut solver = solver(TwinEngine::new(), &fixture);
    fixture.begin(&mut solver);
    solver.linearize(false).expect("runs");
    solver.solve(&fixture.springs(), &LIMITS).expect("runs");
    solver.place(1.0).expect("runs");
    let target = NewtonTarget {
        iterate: &fixture.iterate,
        free: &fixture.free,
        imposed: &fixture.imposed,
        watched: &[3],
    };
    assert_eq!(solver.begin_target(&target).expect("runs").len(), 1);
}

/// The twins, and how much the host asks of them.
#[derive(Debug, Default)]
struct Counting {
    twins: TwinEngine,
    runs: usize,
    waits: usize,
    dispatches: usize,
    written: usize,
    read: usize,
    /// Buffers that were made.
    made: usize,
}

impl Engine for Counting {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
        self.made += 1;
        self.twins.buffer(label, words)
    }

    fn free(&mut self, buffer: BufferId) {
        self.twins.free(buffer);
    }

    fn clear(&mut self) {
        self.twins.clear();
    }

    fn words(&self, buffer: BufferId) -> usize {
        self.twins.words(buffer)
    }

    fn run(&mut self, recording: &Recording, read: &[(BufferId, usize)]) -> Result<Vec<Vec<u32>>, GpuError> {
        self.runs += 1;
        let words: usize = read.iter().map(|(_, words)| words).sum();
        self.waits += usize::from(words > 0);
        self.dispatches += recording.dispatch_count();
        self.written += 4 * recording.words_written();
        self.read += 4 * words;
        self.twins.run(recording, read)
    }
}

/// What a Newton iteration moves between host and device: the figures of `docs/GPU.md`.
#[test]
fn an_iteration_moves_no_vector() {
    let fixture = fixtures().swap_remove(1);
    let mut solver = solver(Counting::default(), &fixture);
    solver.begin_step(&fixture.terms.as_step()).expect("runs");
    let watched = [];
    let target = NewtonTarget {
        iterate: &fixture.iterate,
        free: &fixture.free,
        imposed: &fixture.imposed,
        watched: &watched,
    };
    solver.begin_target(&target).expect("runs");
    let iterate = |solver: &mut ConjugateGradients<Counting>| {
        solver.linearize(false).expect("runs");
        let limits = SolveLimits { tolerance: 1e-2, searches: false, ..LIMITS };
        let solved = solver.solve(&fixture.springs(), &limits).expect("runs");
        let mut sums = Vec::new();
        solver.component_residuals(&mut sums).expect("runs");
        solver.translate(&vec![Vector::new(1e-6, 0.0, 0.0); sums.len()]).expect("runs");
        solver.begin_search().expect("runs");
        solver.start_from_trial().expect("runs");
        solved.info.iterations
    };
    iterate(&mut solver);
    let engine = &mut solver.engine;
    (engine.runs, engine.waits, engine.dispatches, engine.written, engine.read) = (0, 0, 0, 0, 0);
    let iterations = iterate(&mut solver);
    let engine = solver.engine();
    // That the last one was enough is found by the next one. The second batch is as long as the first one
    // lets expect.
    let batches = 1 + usize::from(iterations >= FIRST_BATCH);
    println!(
        "{} nodes, {iterations} linear iterations: {} submissions, {} waits, {} dispatches, {} bytes written, {} bytes read",
        fixture.free.len(),
        engine.runs,
        engine.waits,
        engine.dispatches,
        engine.written,
        engine.read
    );
    assert_eq!((engine.runs, engine.waits), (1 + batches, 1 + batches));
    // The trial of a small model is read as a whole.
    let read = engine.read - 16 * fixture.free.len();
    assert!(engine.written < 400 && read < 2000, "{} and {read}", engine.written);
}

/// Solves for what is inside of solids take turns with those of the whole: their patches and groups are kept.
#[test]
fn two_sets_of_free_nodes_are_made_once() {
    let mut fixture = fixtures().swap_remove(1);
    let all = fixture.free.clone();
    let sets: Vec<Vec<bool>> =
        [1, 2, 3].map(|n| all.iter().enumerate().map(|(v, f)| *f && (n == 1 || v % n > 0)).collect()).into();
    let mut alternate = |keeps: bool| {
        let mut solver = solver(Counting::default(), &fixture);
        solver.begin_step(&fixture.terms.as_step()).expect("runs");
        let (mut steps, mut made) = (Vec::new(), Vec::new());
        for set in [0, 1, 0, 1, 0, 2, 0, 2, 1] {
            if !keeps {
                let assembly = solver.assembly.as_mut().expect("one");
                (assembly.set, assembly.previous) = (None, None);
            }
            let before = solver.engine().made;
            fixture.free.clone_from(&sets[set]);
            fixture.begin_target(&mut solver, &fixture.iterate);
            made.push(solver.engine().made > before);
            solver.linearize(false).expect("runs");
            solver.solve(&fixture.springs(), &LIMITS).expect("runs");
            let step = solver.newton.as_ref().expect("one").vectors.step;
            steps.push(read(&mut solver, step));
        }
        (steps, made)
    };
    let (kept, made) = alternate(true);
    assert_eq!(made, [true, true, false, false, false, true, false, false, true]);
    let (anew, all_made) = alternate(false);
    assert!(all_made.iter().all(|made| *made) && kept == anew);
    assert!(kept[0] != kept[1] && kept[0].iter().any(|step| *step != Vector::zeros()));
}

/// A target writes its iterate once, and not at all where the time step begins.
#[test]
fn an_iterate_is_written_once_at_most() {
    for fixture in fixtures() {
        let nodes = fixture.free.len();
        let start = fixture.terms.as_step().start.to_vec();
        let written_for = |iterate: &[Vector]| {
            let mut solver = solver(Counting::default(), &fixture);
            solver.begin_step(&fixture.terms.as_step()).expect("runs");
            let vectors = solver.newton.as_ref().expect("one").vectors;
            read(&mut solver, vectors.start);
            let before = solver.engine().written;
            let watched = fixture.begin_target(&mut solver, iterate);
            // Buffers for watched nodes are new there.
            let vectors = solver.newton.as_ref().expect("one").vectors;
            read(&mut solver, vectors.iterate);
            let written = solver.engine().written - before;
            for buffer in [vectors.iterate, vectors.target_start] {
                let words = &solver.engine().twins.words_of(buffer)[..4 * nodes];
                let positions: Vec<Vector> = solver.newton.as_ref().expect("one").positions(words).collect();
                assert_eq!(positions, watched, "{}", fixture.name);
            }
            written
        };
        assert_eq!(written_for(&fixture.iterate) - written_for(&start), 16 * nodes, "{}", fixture.name);
    }
}

/// Calls on so many grains that threads and workgroups have several.
fn many_grains<E: Engine + Debug + Send>(engine: E) -> (ConjugateGradients<E>, String) {
    let count = 70_000u32;
    let at = |k: u32| Vector::new(f64::from(k % 300), f64::from(k / 300), 0.3 * f64::from(k % 7)) * 0.01;
    let rest: Vec<Vector> = (0..count).map(at).collect();
    let model = ElementModel {
        starts: vec![0; rest.len() + 1],
        scalar_starts: vec![0; rest.len() + 1],
        // Bodies of many nodes, of a few, and grains.
        components: [0..40_000, 40_000..40_003]
            .into_iter()
            .chain((40_003..count).map(|k| k..k + 1))
            .collect(),
        rest,
        ..ElementModel::default()
    };
    let mass = |k: u32| 1e-3 * f64::from(1 + k % 3);
    let row_sums: Vec<Matrix3<f64>> =
        (0..count).map(|k| Matrix3::from_diagonal_element(2500.0 * mass(k))).collect();
    let gradient: Vec<Vector> =
        (0..count).map(|k| Vector::new(0.1, f64::from(k % 5), 9.81) * mass(k)).collect();
    let inertial: Vec<Vector> = model.rest.iter().map(|x| x - Vector::new(0.0, 0.0, 0.003)).collect();
    let step = NewtonStep {
        start: &model.rest,
        inertial: &inertial,
        rate: 50.0,
        row_sums: &row_sums,
        gradient: &gradient,
        bending: &[],
        scalars: &[],
    };
    let free: Vec<bool> = (0..count).map(|k| k % 1000 != 999).collect();
    let imposed = vec![Vector::zeros(); free.len()];
    let target = NewtonTarget { iterate: &model.rest, free: &free, imposed: &imposed, watched: &[7, 66_000] };
    let mut solver = ConjugateGradients::new("grains".to_owned(), engine);
    solver.set_model(&model).expect("room");
    solver.begin_step(&step).expect("runs");
    solver.begin_target(&target).expect("runs");
    solver.linearize(false).expect("runs");
    let solved = solver.solve(&AssemblySprings::default(), &LIMITS).expect("runs");
    let vectors = solver.newton.as_ref().expect("one").vectors;
    let p = read(&mut solver, vectors.step);
    let (mut product, mut most) = (0.0, 0.0f64);
    for k in 0..p.len() {
        let way = if free[k] { -gradient[k] / row_sums[k][(0, 0)] } else { Vector::zeros() };
        assert!((p[k] - way).amax() < 1e-5 * way.amax() + 1e-12, "{k}: {} and {way}", p[k]);
        product -= if free[k] { way.dot(&gradient[k]) } else { 0.0 };
        most = most.max(way.norm());
    }
    let trial = solver.place(1.0).expect("runs");
    assert!((trial.predicted - product).abs() < 1e-5 * product, "{} and {product}", trial.predicted);
    assert!((trial.from_iterate - most).abs() < 1e-5 * most, "{} and {most}", trial.from_iterate);
    let mut sums = Vec::new();
    solver.component_residuals(&mut sums).expect("runs");
    assert_eq!(sums.len(), model.components.len());
    for (sum, component) in sums.iter().zip(&model.components) {
        let nodes = component.start as usize..component.end as usize;
        let expected: Vector = nodes.clone().map(|k| -gradient[k] - row_sums[k] * p[k]).sum();
        let scale: f64 = nodes.map(|k| gradient[k].norm()).sum();
        assert!((sum - expected).norm() < 16.0 * UNIT * scale, "{component:?}");
    }
    let counted = vec![true; free.len()];
    let balance = solver
        .out_of_balance(&AssemblySprings::default(), &[Vector::zeros(); 2], &counted, false)
        .expect("runs");
    let force: f64 = (0..p.len()).filter(|k| free[*k]).map(|k| gradient[k].norm_squared()).sum();
    assert!((balance.squared_force - force).abs() < 1e-5 * force, "{} and {force}", balance.squared_force);
    (solver, format!("{solved:?} {trial:?} {sums:?} {balance:?}"))
}

#[test]
fn threads_have_several_nodes() {
    many_grains(TwinEngine::new());
    let (solver, _) = many_grains(ComparingEngine::new(device()));
    assert!(solver.engine().differences().is_empty(), "{:?}", &solver.engine().differences()[..1]);
    assert!(many_grains(device()).1 == many_grains(device()).1);
}
