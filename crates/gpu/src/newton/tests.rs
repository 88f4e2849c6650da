//! Each function of the backend beside double precision on the twins, and kernels beside their twins.

mod fixture;

use crate::adapter::Adapter;
use crate::engine::{ComparingEngine, DeviceEngine, Engine, TwinEngine};
use crate::error::GpuError;
use crate::linear::ConjugateGradients;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{AssemblySprings, ElementModel, NewtonBackend, NewtonStep, NewtonTarget, SolveLimits};
use bowknot_geometry::{Point, Vector};
use fixture::{DT, Fixture, LIMITS, dense_solve, fixtures, flat, masked, matrix, read, solver};
use nalgebra::{DMatrix, DVector, Matrix3};
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

#[test]
fn right_sides_and_solutions_are_those_of_dense_algebra() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        // Positions are on a grid that is finer than 2^-27 of the state and of the way that it moves.
        assert!(x.iter().zip(&fixture.iterate).all(|(a, b)| (a - b).amax() < 1e-8), "{}", fixture.name);
        solver.linearize(false).expect("runs");
        // The second solve has a last target as well.
        for round in 0..2 {
            let solved = solver.solve(&fixture.springs(), &LIMITS).expect("runs");
            assert!(solved.info.converged && !solved.stalled, "{}: {solved:?}", fixture.name);
            let vectors = solver.newton.as_ref().expect("one").vectors;
            let (b, p) =
                (flat(&read(&mut solver, vectors.right_side)), flat(&read(&mut solver, vectors.step)));
            let h = matrix(&mut solver);
            let opposed = flat(&fixture.gradient(&x)) + &h * flat(&fixture.imposed);
            let expected_b = masked(&-opposed, &fixture.free);
            let unit = UNIT * fixture.force_scale(&x);
            let error = largest(&(&b - &expected_b)) / unit;
            println!("{}: b off by {error:.1} units, of {:.1e}", fixture.name, largest(&b) / unit);
            assert!(error < 40.0, "{}: {error}", fixture.name);
            let expected = dense_solve(&h, &b, &fixture.free);
            // In the norm of H: the residual is as small in that of the preconditioner, which approximates the inverse.
            let norm = |p: &DVector<f64>| p.dot(&(&h * p)).sqrt();
            let error = norm(&(&p - &expected)) / norm(&expected);
            println!("{}: p off by {error:.1e}, {} iterations", fixture.name, solved.info.iterations);
            assert!(error < 1e-4, "{}: {error:e}", fixture.name);
            if round == 0 {
                assert!(largest(&expected) > 1e-5, "{}: something moves", fixture.name);
                solver.place(1.0).expect("runs");
                let mut y = vec![Vector::zeros(); x.len()];
                solver.target(&mut y).expect("runs");
                assert!(fixture.begin_target(&mut solver, &fixture.iterate) == x);
            }
        }
    }
}

/// Without iterations the step is the combination of guesses with the least energy.
#[test]
fn solves_start_from_the_best_combination_of_guesses() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        solver.linearize(false).expect("runs");
        let limits = SolveLimits { max_iterations: 0, ..LIMITS };
        let inertial = fixture.terms.as_step().inertial;
        let mut guesses = vec![inertial.to_vec()];
        for _ in 0..2 {
            let solved = solver.solve(&fixture.springs(), &limits).expect("runs");
            assert!(solved.info.iterations == 0 && !solved.stalled);
            let vectors = solver.newton.as_ref().expect("one").vectors;
            let (b, p) =
                (flat(&read(&mut solver, vectors.right_side)), flat(&read(&mut solver, vectors.step)));
            let h = matrix(&mut solver);
            let way = |end: &Vec<Vector>| masked(&(flat(end) - flat(&x)), &fixture.free);
            let ways = DMatrix::from_columns(&guesses.iter().map(way).collect::<Vec<_>>());
            let small = ways.transpose() * &h * &ways;
            let expected = &ways * small.try_inverse().expect("independent") * ways.transpose() * &b;
            let energy = |p: &DVector<f64>| 0.5 * p.dot(&(&h * p)) - p.dot(&b);
            let missed = (energy(&p) - energy(&expected)) / energy(&expected).abs();
            println!("{}: {missed:.1e} of the decrease", fixture.name);
            assert!(missed.abs() < 1e-4, "{}: {missed:e}", fixture.name);
            // The residual that the solve reports is that of b - H p, in the norm of the preconditioner.
            assert!(solved.info.residual > 0.0, "{}", fixture.name);
            // A last target elsewhere, with a deformation of its own.
            let last: Vec<Vector> = x
                .iter()
                .zip(inertial)
                .enumerate()
                .map(|(k, (x, y))| x + (y - x) * 0.6 + Vector::new((k as f64).sin(), 0.3, 0.1) * 1e-4)
                .collect();
            let last = fixture.begin_target(&mut solver, &last);
            solver.target(&mut vec![Vector::zeros(); last.len()]).expect("runs");
            fixture.begin_target(&mut solver, &fixture.iterate);
            guesses.push(last);
        }
    }
}

/// What is summed over components is b - R p, without what sums to zero; translations take it away.
#[test]
fn components_get_their_momentum() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        solver.linearize(false).expect("runs");
        solver.solve(&fixture.springs(), &SolveLimits { tolerance: 0.1, ..LIMITS }).expect("runs");
        let vectors = solver.newton.as_ref().expect("one").vectors;
        let gradient = fixture.gradient(&x);
        let step = fixture.terms.as_step();
        let components = &fixture.model.components;
        let nodes = |c: usize| components[c].start as usize..components[c].end as usize;
        for round in 0..2 {
            let p = read(&mut solver, vectors.step);
            let mut sums = Vec::new();
            solver.component_residuals(&mut sums).expect("runs");
            assert_eq!(sums.len(), components.len());
            let mut again = Vec::new();
            solver.component_residuals(&mut again).expect("runs");
            assert_eq!(sums, again);
            let mut ways = Vec::new();
            for (c, sum) in sums.iter().enumerate() {
                let expected: Vector = nodes(c).map(|n| -gradient[n] - step.row_sums[n] * p[n]).sum();
                // The pairs of bending and elements are exact in double precision; here inertia alone is rounded.
                let moved = |n: usize| x[n] - step.start[n] + p[n];
                let scale: f64 = nodes(c).map(|n| (step.row_sums[n] * moved(n)).norm()).sum();
                let error = (sum - expected).norm() / scale;
                assert!(error < 16.0 * UNIT, "{}: {error:e}", fixture.name);
                if round == 1 && nodes(c).all(|n| fixture.free[n]) {
                    assert!(sum.norm() < 16.0 * UNIT * scale, "{}: {:e}", fixture.name, sum.norm() / scale);
                }
                let total: Matrix3<f64> = nodes(c).map(|n| step.row_sums[n]).sum();
                ways.push(total.try_inverse().expect("a mass") * sum);
            }
            solver.translate(&ways).expect("runs");
            let after = read(&mut solver, vectors.step);
            for c in 0..components.len() {
                for n in nodes(c) {
                    let way = if fixture.free[n] { ways[c] } else { Vector::zeros() };
                    assert!((after[n] - p[n] - way).norm() <= 4.0 * UNIT * (p[n].norm() + way.norm()));
                }
            }
        }
    }
}

#[test]
fn trials_are_on_the_line_and_have_their_energies() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        let before = solver.place(0.0).expect("runs");
        assert_eq!((before.predicted, before.largest_step, before.from_iterate), (0.0, 0.0, 0.0));
        solver.linearize(false).expect("runs");
        solver.solve(&fixture.springs(), &LIMITS).expect("runs");
        let vectors = solver.newton.as_ref().expect("one").vectors;
        let (b, p) = (read(&mut solver, vectors.right_side), read(&mut solver, vectors.step));
        let reference = solver.place(0.0).expect("runs");
        assert_eq!((reference.change, reference.watched == before.watched), (0.0, true));
        let potential = |x: &[Vector]| fixture.dynamics.bodies_potential(x).expect("a step");
        let at_reference = potential(&reference.watched);
        let quantum = solver.newton.as_ref().expect("one").grid.quantum;
        for length in [1.0, 0.5, 0.25] {
            let trial = solver.place(length).expect("runs");
            for n in 0..x.len() {
                let way = if fixture.free[n] { p[n] * length } else { fixture.imposed[n] };
                assert!((trial.watched[n] - x[n] - way).amax() <= 1.01 * quantum, "{}", fixture.name);
            }
            let at_trial = potential(&trial.watched);
            let all = |p: &bowknot_dynamics::BodiesPotential| p.quadratic + p.elements;
            let change =
                at_trial.quadratic - at_reference.quadratic + at_trial.elements - at_reference.elements;
            let apart = (trial.change - change).abs();
            assert!(apart <= trial.rounding, "{}: {apart:e} of {:e}", fixture.name, trial.rounding);
            assert!(
                trial.rounding < 0.1 * change.abs(),
                "{}: {:e} of {change:e}",
                fixture.name,
                trial.rounding
            );
            let apart = (trial.reference - all(&at_reference)).abs();
            assert!(
                apart <= 1e-4 * (at_reference.quadratic.abs() + at_reference.elements),
                "{}",
                fixture.name
            );
            let predicted: f64 = p.iter().zip(&b).map(|(p, b)| p.dot(b)).sum();
            assert!((trial.predicted - predicted).abs() < 1e-5 * predicted.abs(), "{}", fixture.name);
            let most = p.iter().map(|p| p.amax()).fold(0.0, f64::max);
            assert!((trial.largest_step - most).abs() < 1e-6 * most, "{}", fixture.name);
            let way = |n: &usize| (trial.watched[*n] - x[*n]).norm();
            let far = (0..x.len()).filter(|n| fixture.free[*n]).map(|n| way(&n)).fold(0.0, f64::max);
            for found in [trial.from_iterate, trial.from_start] {
                assert!((found - far).abs() < 1e-6 * far, "{}: {found} and {far}", fixture.name);
            }
        }
    }
}

#[test]
fn iterates_move_and_return() {
    let fixture = &fixtures()[0];
    let mut solver = solver(TwinEngine::new(), fixture);
    let x = fixture.begin(&mut solver);
    solver.linearize(false).expect("runs");
    solver.solve(&fixture.springs(), &LIMITS).expect("runs");
    let first = solver.place(1.0).expect("runs");
    solver.keep_trial().expect("runs");
    let half = solver.place(0.5).expect("runs");
    solver.start_from_trial().expect("runs");
    // Nodes that are not free are at their ends: nothing is imposed any more.
    let again = solver.place(0.0).expect("runs");
    assert!(again.watched == half.watched && again.from_iterate == 0.0 && again.from_start > 0.0);
    solver.linearize(false).expect("runs");
    let gradient = solver.newton.as_ref().expect("one").vectors.gradient;
    let moved = read(&mut solver, gradient);
    let expected = fixture.dynamics.bodies_potential(&half.watched).expect("a step").gradient;
    let error = largest(&(flat(&moved) - flat(&expected)));
    assert!(error < 40.0 * UNIT * fixture.force_scale(&half.watched), "{error:e}");
    solver.start_from_kept_trial().expect("runs");
    let kept = solver.place(0.0).expect("runs");
    assert!(kept.watched == first.watched && kept.from_iterate == 0.0);
    let mut y = vec![Vector::zeros(); x.len()];
    solver.target(&mut y).expect("runs");
    assert_eq!(y, first.watched);
    assert_eq!(solver.begin_again().expect("runs"), x);
    let back = solver.place(0.0).expect("runs");
    for n in 0..x.len() {
        assert!((back.watched[n] - x[n] - fixture.imposed[n]).amax() < 1e-8);
    }
    solver.linearize(false).expect("runs");
    let returned = read(&mut solver, gradient);
    assert!(returned != moved);
}

#[test]
fn forces_out_of_balance_are_those_of_the_cpu() {
    for mut fixture in fixtures() {
        fixture.springs.clear();
        fixture.model.patches.clear();
        let rest: Vec<Point> = fixture.dynamics.model().rest_positions().to_vec();
        let node = |vertex: &Point| fixture.model.rest.iter().position(|x| *x == vertex.coords).expect("one");
        let nodes: Vec<usize> = rest.iter().map(node).collect();
        let counted: Vec<bool> = (0..fixture.free.len()).map(|n| n % 5 != 2).collect();
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        let by_vertex = |values: &[bool]| nodes.iter().map(|n| values[*n]).collect::<Vec<bool>>();
        let points: Vec<Point> = nodes.iter().map(|n| Point::from(x[*n])).collect();
        let held: Vec<bool> = by_vertex(&fixture.free).iter().map(|free| !free).collect();
        let expected = fixture.dynamics.residual(&points, &held, &by_vertex(&counted)).expect("a step");
        let none = vec![Vector::zeros(); x.len()];
        let found = solver.out_of_balance(&none, &counted, false).expect("runs");
        let (mut largest, mut worst) = (0.0f64, 0.0f64);
        for (component, product) in fixture.model.components.iter().zip(&found.products) {
            let free = component.clone().filter(|n| fixture.free[*n as usize]);
            let mass: f64 = free.map(|n| fixture.masses[n as usize]).sum();
            assert!(*product >= 0.0);
            largest = largest.max(if mass > 0.0 { product / mass } else { 0.0 });
            worst = worst.max(*product);
        }
        let force = found.squared_force.sqrt();
        println!("{}: {force:e} and {:e} N", fixture.name, expected.force);
        assert!((force - expected.force).abs() < 1e-4 * expected.force, "{}", fixture.name);
        let distance = DT * largest.sqrt();
        println!("{}: {distance:e} and {:e} m", fixture.name, expected.distance);
        assert!((distance - expected.distance).abs() < 1e-3 * expected.distance, "{}", fixture.name);

        // Known forces that are all there are leave nothing, and do not change the gradient.
        let gradient = fixture.gradient(&x);
        let balanced = solver.out_of_balance(&gradient, &counted, false).expect("runs");
        assert!(balanced.squared_force.sqrt() < 1e-4 * force, "{}: {balanced:?}", fixture.name);
        assert!(worst > 0.0 && solver.out_of_balance(&none, &counted, false).expect("runs") == found);
    }
}

/// An iterate far from where the step began: the grid becomes coarser, and all that lies on it stays where it is.
#[test]
fn grids_change_within_a_step() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let near = fixture.begin(&mut solver);
        let mut y = vec![Vector::zeros(); near.len()];
        solver.target(&mut y).expect("runs");
        let fine = solver.newton.as_ref().expect("one").grid.quantum;
        let far: Vec<Vector> = fixture.iterate.iter().map(|x| x + Vector::new(40.0, -3.0, 1.0)).collect();
        let x = fixture.begin_target(&mut solver, &far);
        let newton = solver.newton.as_ref().expect("one");
        let (vectors, coarse) = (newton.vectors, newton.grid.quantum);
        assert!(coarse >= 16.0 * fine, "{}", fixture.name);
        assert!(x.iter().zip(&far).all(|(a, b)| (a - b).amax() <= 0.51 * coarse), "{}", fixture.name);
        let step = fixture.terms.as_step();
        for (buffer, expected) in
            [(vectors.start, step.start), (vectors.inertial, step.inertial), (vectors.last, &y)]
        {
            let words = solver.engine.words_of(buffer);
            let newton = solver.newton.as_ref().expect("one");
            let positions: Vec<Vector> = newton.positions(&words).take(expected.len()).collect();
            let apart = positions.iter().zip(expected).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
            assert!(apart <= 1.1 * coarse, "{}: {apart:e}", fixture.name);
        }
        // A step that leads out of the grid makes it coarser, too.
        solver.linearize(false).expect("runs");
        solver.solve(&fixture.springs(), &LIMITS).expect("runs");
        let ways = vec![Vector::new(0.0, 0.0, -300.0); fixture.model.components.len()];
        let reference = solver.place(0.0).expect("runs");
        solver.translate(&ways).expect("runs");
        let p = read(&mut solver, vectors.step);
        let trial = solver.place(1.0).expect("runs");
        let quantum = solver.newton.as_ref().expect("one").grid.quantum;
        assert!(quantum > coarse, "{}", fixture.name);
        for n in (0..x.len()).filter(|n| fixture.free[*n]) {
            let error = (trial.watched[n] - reference.watched[n] - p[n]).amax();
            assert!(error <= 1.6 * quantum + 300.0 * UNIT, "{}: {error:e} of {quantum:e}", fixture.name);
        }
        let way = |n: usize| (trial.watched[n] - x[n]).norm();
        let all = (0..x.len()).filter(|n| fixture.free[*n]).map(way).fold(0.0, f64::max);
        assert!((trial.from_iterate - all).abs() < 1e-5 * all && all > 250.0, "{}: {all}", fixture.name);
        // One that leads farther than any state ends at the border of the grid.
        for way in [1e9, 1e38] {
            solver.translate(&vec![Vector::new(way, 0.0, 0.0); ways.len()]).expect("runs");
            let trial = solver.place(1.0).expect("runs");
            assert!(trial.watched.iter().all(|x| x.amax() < 1e5), "{}", fixture.name);
        }
    }
}

/// All calls once, as a Newton iteration makes them. Returns the end and what was told on the way.
///
/// The second target begins where the first has ended, or `returns`: near equilibrium forces are differences of large ones,
/// so that kernels and twins agree by less.
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
    log += &format!("{:?}", solver.out_of_balance(&known, &counted, true).expect("runs"));
    (y, log)
}

#[test]
fn every_kernel_computes_what_its_twin_computes() {
    for fixture in fixtures() {
        let mut solver = solver(ComparingEngine::new(device()), &fixture);
        run(&fixture, &mut solver, true);
        let engine = solver.engine();
        assert!(engine.differences().is_empty(), "{}: {:?}", fixture.name, &engine.differences()[..1]);
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

/// Forces of 1e-12 and of 1e12 times the usual ones: powers of two change no digit.
#[test]
fn units_of_force_make_no_difference() {
    let fixture = fixtures().pop().expect("grains");
    let p = |exponent: i32| {
        let factor = 2f64.powi(exponent);
        let mut solver = solver(TwinEngine::new(), &fixture);
        let step = fixture.terms.as_step();
        let row_sums: Vec<Matrix3<f64>> = step.row_sums.iter().map(|sum| sum * factor).collect();
        let gradient: Vec<Vector> = step.gradient.iter().map(|c| c * factor).collect();
        let step = NewtonStep { row_sums: &row_sums, gradient: &gradient, ..step };
        solver.begin_step(&step).expect("runs");
        fixture.begin_target(&mut solver, &fixture.iterate);
        solver.linearize(false).expect("runs");
        let mut springs = fixture.springs.clone();
        for spring in &mut springs {
            (spring.hessian, spring.force) = (spring.hessian * factor, spring.force * factor);
        }
        let springs = AssemblySprings { springs: &springs, ..fixture.springs() };
        let limits = SolveLimits { own_tolerance: 1e-5, min_scale: 1e-12 * factor, ..LIMITS };
        let solved = solver.solve(&springs, &limits).expect("runs");
        assert!(solved.info.converged, "{exponent}: {solved:?}");
        let vectors = solver.newton.as_ref().expect("one").vectors;
        (read(&mut solver, vectors.step), solved.info.iterations, (solved.scale / factor).to_bits())
    };
    let one = p(0);
    assert!(one.1 > 1, "{}", one.1);
    for exponent in [-40, 40] {
        assert!(p(exponent) == one, "{exponent}");
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
    assert!(NewtonBackend::set_model(&mut without, &empty).expect("room"));
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
}

impl Engine for Counting {
    fn buffer(&mut self, label: &'static str, words: usize) -> Result<BufferId, GpuError> {
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
        let solved =
            solver.solve(&fixture.springs(), &SolveLimits { tolerance: 1e-2, ..LIMITS }).expect("runs");
        let mut sums = Vec::new();
        solver.component_residuals(&mut sums).expect("runs");
        solver.translate(&vec![Vector::new(1e-6, 0.0, 0.0); sums.len()]).expect("runs");
        solver.place(0.0).expect("runs");
        solver.place(1.0).expect("runs");
        solver.start_from_trial().expect("runs");
        solved.info.iterations
    };
    iterate(&mut solver);
    let engine = &mut solver.engine;
    (engine.runs, engine.waits, engine.dispatches, engine.written, engine.read) = (0, 0, 0, 0, 0);
    let iterations = iterate(&mut solver);
    let engine = solver.engine();
    let batches = iterations / 16 + 1;
    println!(
        "{} nodes, {iterations} linear iterations: {} submissions, {} waits, {} dispatches, {} bytes written, {} bytes read",
        fixture.free.len(),
        engine.runs,
        engine.waits,
        engine.dispatches,
        engine.written,
        engine.read
    );
    assert_eq!((engine.runs, engine.waits), (5 + batches, 2 + batches));
    assert!(engine.written < 400 && engine.read < 2000, "{} and {}", engine.written, engine.read);
}
