//! Gradients and energies beside those in double precision, on the twins and on a device.

mod cases;

use super::layout::{MOST_WORKGROUPS, THREADS};
use super::record::ROUNDING_UNITS;
use super::{Potential, PotentialChange};
use crate::adapter::Adapter;
use crate::assembly::{AssemblyBuffers, Plan};
use crate::engine::{ComparingEngine, DeviceEngine, Engine, TwinEngine};
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{BodiesPotential, NewtonStep};
use bowknot_geometry::Vector;
use cases::{Amounts, Problem, State, cases, long_block, single_elements};

/// The rounding of a number in single precision.
const UNIT: f64 = 0.5 * f32::EPSILON as f64;

/// Strong deformations: edges change their lengths by up to a half, and some tetrahedra are inside out.
const STRONG: Amounts = Amounts { start: 0.1, reference: 0.5, trial: 0.1, fall: 0.004 };

/// The largest ratio of lengths to those at rest in these states.
const STRETCH: f64 = 2.0;

fn device() -> DeviceEngine {
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    DeviceEngine::open(&adapter).unwrap_or_else(|error| panic!("{error}"))
}

/// The potential of a problem on an engine.
struct Run<E> {
    engine: E,
    potential: Potential,
    start: BufferId,
    reference: BufferId,
    trial: BufferId,
    gradient: BufferId,
}

impl<E: Engine> Run<E> {
    fn new(mut engine: E, problem: &Problem) -> Self {
        let nodes = problem.model.rest.len();
        let elements = AssemblyBuffers::new(&mut engine, Plan::new(&problem.model)).expect("room").elements();
        let mut potential = Potential::new(&mut engine, &problem.model, elements).expect("room");
        let mut buffer = |label| engine.buffer(label, 4 * nodes).expect("room");
        let [start, reference, trial] = ["start", "reference", "trial"].map(&mut buffer);
        let gradient = buffer("gradient");
        let mut recording = Recording::default();
        potential
            .write_step(&mut engine, &problem.model, &problem.terms.as_step(), &mut recording)
            .expect("room");
        recording.write(start, &problem.start.integers);
        engine.run(&recording, &[]).expect("runs");
        Self { engine, potential, start, reference, trial, gradient }
    }

    fn gradient_words(&mut self, problem: &Problem, at: &State) -> Vec<u32> {
        let mut recording = Recording::default();
        recording.write(self.reference, &at.integers);
        let places = problem.places([self.reference, self.start]);
        self.potential.record_gradient(places, self.gradient, &mut recording);
        let words = 4 * at.integers.len();
        self.engine.run(&recording, &[(self.gradient, words)]).expect("runs").remove(0)
    }

    fn gradient(&mut self, problem: &Problem, at: &State) -> Vec<Vector> {
        let words = self.gradient_words(problem, at);
        let number = |word: u32| f64::from(f32::from_bits(word));
        words.chunks_exact(4).map(|w| Vector::new(number(w[0]), number(w[1]), number(w[2]))).collect()
    }

    fn energy_words(&mut self, problem: &Problem, reference: &State, trial: &State) -> Vec<u32> {
        let mut recording = Recording::default();
        recording.write(self.reference, &reference.integers);
        recording.write(self.trial, &trial.integers);
        let quantum = problem.quantum as f32;
        self.potential.record_energies(self.reference, self.trial, self.start, quantum, &mut recording);
        self.engine.run(&recording, &[self.potential.energy_words()]).expect("runs").remove(0)
    }

    fn energies(&mut self, problem: &Problem, reference: &State, trial: &State) -> PotentialChange {
        let words = self.energy_words(problem, reference, trial);
        self.potential.energies(&words)
    }
}

fn expected(problem: &Problem, at: &State) -> BodiesPotential {
    problem.dynamics.bodies_potential(&at.positions).expect("a step")
}

/// The sizes of the quadratic terms of the gradient by each node [N].
fn quadratic_sizes(problem: &Problem, at: &State) -> Vec<f64> {
    let step = problem.terms.as_step();
    let moved: Vec<Vector> = at.positions.iter().zip(step.start).map(|(x, start)| x - start).collect();
    let model = &problem.model;
    (0..moved.len())
        .map(|i| {
            let rows = [
                (&model.starts, &model.columns, step.bending),
                (&model.scalar_starts, &model.scalar_columns, step.scalars),
            ];
            let bent = rows.iter().map(|(starts, columns, values)| {
                let row = starts[i] as usize..starts[i + 1] as usize;
                let pairs = columns[row.clone()].iter().zip(&values[row]);
                pairs.map(|(j, value)| (moved[*j as usize] - moved[i]).norm() * value.abs()).sum::<f64>()
            });
            step.row_sums[i].norm() * moved[i].norm() + step.gradient[i].norm() + bent.sum::<f64>()
        })
        .collect()
}

/// A number of the gradient passes through some twenty operations, from the deformation on, which amplify
/// rounding by up to the stiffness times the lengths of the elements around the node.
#[test]
fn gradients_are_those_of_double_precision() {
    for case in cases() {
        let problem = Problem::new(&case, STRONG, 1);
        let mut run = Run::new(TwinEngine::new(), &problem);
        let found = run.gradient(&problem, &problem.reference);
        let expected = expected(&problem, &problem.reference).gradient;
        let scales = problem.force_scales(STRETCH);
        let sizes = quadratic_sizes(&problem, &problem.reference);
        let ratio = |i: usize| (found[i] - expected[i]).norm() / (UNIT * (scales[i] + sizes[i]));
        let worst = (0..found.len()).map(ratio).fold(0.0, f64::max);
        let size = (0..found.len()).map(|i| expected[i].norm() / scales[i]).fold(0.0, f64::max);
        let inverted = problem.inverted(&problem.reference);
        assert_eq!(inverted > 0, !problem.model.tetrahedra.is_empty(), "{}: {inverted}", problem.name);
        println!("{}: {worst:.2} units, forces up to {size:.1e} of the scale", problem.name);
        assert!(worst < 20.0, "{}: {worst} units", problem.name);
        assert!(size > 0.01, "{}: there are large forces", problem.name);
    }
}

/// A body that has turned and falls has no strain, and elements leave the sum of forces alone.
#[test]
fn elements_do_not_feel_motions_of_the_whole_and_do_not_move_it() {
    for case in cases() {
        let rigid = Amounts { start: 0.0, reference: 0.0, trial: 0.0, fall: 0.3 };
        for (amounts, stretch) in [(rigid, 1.0), (STRONG, STRETCH)] {
            let problem = Problem::new(&case, amounts, 2);
            let mut run = Run::new(TwinEngine::new(), &problem);
            let found = run.gradient(&problem, &problem.reference);
            let step = problem.terms.as_step();
            let scales = problem.force_scales(stretch);
            let mut sum = Vector::zeros();
            for (i, gradient) in found.iter().enumerate() {
                let moved = problem.reference.positions[i] - step.start[i];
                let (inertia, push) = (step.row_sums[i] * moved, step.gradient[i]);
                let elements = gradient - inertia - push;
                // R and c are rounded, and so is their sum.
                let rounding = 4.0 * UNIT * (inertia.norm() + push.norm());
                if amounts.reference == 0.0 {
                    let bound = 1e-6 * scales[i] + rounding;
                    assert!(elements.norm() < bound, "{}: {elements} of {bound:e}", problem.name);
                }
                sum += elements;
            }
            let quadratic: f64 = quadratic_sizes(&problem, &problem.reference).iter().sum();
            // The scales are those of the largest forces, and rounding has both signs.
            let bound = 0.2 * UNIT * (scales.iter().sum::<f64>() + quadratic);
            println!("{}: sum {:.1e} of {bound:.1e}", problem.name, sum.norm());
            assert!(sum.norm() < bound, "{}: {sum} of {bound:e}", problem.name);
        }
    }
}

/// From small changes to large ones, of strongly deformed bodies and of bodies near rest.
#[test]
fn changes_of_energy_are_those_of_double_precision() {
    for case in cases() {
        for (start, reference) in [(0.1, 0.5), (0.0, 0.0), (1e-3, 1e-3)] {
            for (trial, seed) in [1e-6, 1e-4, 1e-2, 0.5].into_iter().zip(3..) {
                let amounts = Amounts { start, reference, trial, fall: 0.05 * trial };
                let problem = Problem::new(&case, amounts, seed);
                let mut run = Run::new(TwinEngine::new(), &problem);
                let found = run.energies(&problem, &problem.reference, &problem.trial);
                let [before, after] = [&problem.reference, &problem.trial].map(|at| expected(&problem, at));
                let (quadratic, elements) =
                    (after.quadratic - before.quadratic, after.elements - before.elements);
                let terms = quadratic.abs() + elements.abs();
                let error = (found.change - quadratic - elements).abs();
                let name = problem.name;
                println!(
                    "{name}, {reference} then {trial}: {:.1e} of the terms, {:.3} of the bound, {:.1e} of the terms",
                    error / terms,
                    error / found.rounding,
                    found.rounding / terms
                );
                // The differences of energies in double precision have an error, too.
                let double = 1e-14 * (before.elements + after.elements + before.quadratic.abs());
                assert!(error <= found.rounding + double, "{name}: {error:e} of {:e}", found.rounding);
                if reference > 0.1 {
                    assert!(error <= 1e-5 * terms, "{name}: {error:e} of {terms:e}");
                    assert!(found.rounding <= 1e-3 * terms, "{name}: {:e} of {terms:e}", found.rounding);
                    let sum = before.quadratic + before.elements;
                    let size = before.quadratic.abs() + before.elements;
                    assert!((found.reference - sum).abs() <= 1e-5 * size, "{name}: {found:?}, {sum:e}");
                }
            }
        }
    }
}

#[test]
fn energies_change_as_the_gradient_says() {
    for case in cases() {
        let problem = Problem::new(&case, STRONG, 9);
        let mut run = Run::new(TwinEngine::new(), &problem);
        let gradient = run.gradient(&problem, &problem.reference);
        let random = &mut fastrand::Rng::with_seed(4);
        // Even numbers of quanta: half of the way is a state, too.
        let steps: Vec<[i32; 4]> = gradient
            .iter()
            .map(|_| [0, 1, 2].map(|_| random.i32(-20_000..20_000)))
            .map(|[x, y, z]| [x, y, z, 0])
            .collect();
        let at = |sign: i32| {
            let moved = |(x, step): (&[i32; 4], &[i32; 4])| [0, 1, 2, 3].map(|k| x[k] + sign * step[k]);
            let integers = problem.reference.integers.iter().zip(&steps).map(moved).collect();
            State { integers, positions: Vec::new() }
        };
        let found = run.energies(&problem, &at(-1), &at(1));
        let step = |s: &[i32; 4]| Vector::new(s[0].into(), s[1].into(), s[2].into()) * problem.quantum;
        let products: Vec<f64> = gradient.iter().zip(&steps).map(|(g, s)| 2.0 * g.dot(&step(s))).collect();
        let expected: f64 = products.iter().sum();
        let size: f64 = products.iter().map(|product| product.abs()).sum();
        let error = (found.change - expected).abs();
        println!("{}: {:.1e}, {:.1e}", problem.name, error / size, found.rounding / size);
        assert!(error < 1e-6 * size + found.rounding, "{}: {error:e} of {size:e}", problem.name);
        assert!(found.rounding < 1e-3 * size, "{}: {found:?} of {size:e}", problem.name);
    }
}

/// Of elements that are alone, in all kinds of states: the sum over many of them then has a bound as well.
#[test]
fn rounding_of_every_element_is_bounded() {
    for case in single_elements() {
        let mut worst = [0.0f64; 2];
        for seed in 0..600 {
            let random = &mut fastrand::Rng::with_seed(seed);
            let mut amount = |largest: f64| largest * 10f64.powf(-7.0 * random.f64());
            let amounts =
                Amounts { start: amount(1.0), reference: amount(2.0), trial: amount(2.0), fall: amount(0.1) };
            let problem = Problem::new(&case, amounts, seed);
            let mut run = Run::new(TwinEngine::new(), &problem);
            run.energy_words(&problem, &problem.reference, &problem.trial);
            let words = run.engine.words_of(run.potential.parts);
            let part = |words: &[u32]| [1, 2].map(|k| f64::from(f32::from_bits(words[k])));
            let mut parts: Vec<[f64; 2]> = words.chunks_exact(4).map(part).collect();
            parts.truncate(run.potential.part_count());
            let nodes = parts.pop().expect("nodes");
            let elements = parts.iter().fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
            let [before, after] = [&problem.reference, &problem.trial].map(|at| expected(&problem, at));
            // The differences of energies in double precision have an error, too.
            let units = |[change, size]: [f64; 2], before: f64, after: f64| {
                let double = 1e-15 * (before.abs() + after.abs());
                ((change - (after - before)).abs() - double).max(0.0) / (UNIT * size)
            };
            worst[0] = worst[0].max(units(elements, before.elements, after.elements));
            worst[1] = worst[1].max(units(nodes, before.quadratic, after.quadratic));
        }
        println!("{}: {worst:.2?} units, of elements and nodes", case.name);
        assert!(worst[0].max(worst[1]) < 0.5 * ROUNDING_UNITS, "{}: {worst:?}", case.name);
        assert!(worst[0].min(worst[1]) > 0.1, "{}: {worst:?}, the bound is too large", case.name);
    }
}

/// Threads go on to the next elements where there are more of them than threads.
#[test]
fn more_elements_than_threads_have_the_energy_of_double_precision() {
    let problem = Problem::new(&long_block(12_000), STRONG, 8);
    assert!(problem.model.tetrahedra.len() > THREADS * MOST_WORKGROUPS);
    let mut run = Run::new(device(), &problem);
    let found = run.energies(&problem, &problem.reference, &problem.trial);
    let [before, after] = [&problem.reference, &problem.trial].map(|at| expected(&problem, at));
    let expected = after.quadratic + after.elements - before.quadratic - before.elements;
    let error = (found.change - expected).abs();
    println!("{:.1e}, {:.1e} of {:.1e}", error, found.rounding, expected);
    assert!(error < found.rounding && error < 1e-5 * expected.abs(), "{found:?} and {expected:e}");
}

#[test]
fn what_has_not_changed_is_not_written_again() {
    let problem = Problem::new(&cases()[2], STRONG, 10);
    let mut run = Run::new(TwinEngine::new(), &problem);
    let terms = problem.terms.as_step();
    let mut words = |step: &NewtonStep<'_>| {
        let mut recording = Recording::default();
        let Run { engine, potential, .. } = &mut run;
        potential.write_step(engine, &problem.model, step, &mut recording).expect("room");
        recording.words_written()
    };
    let nodes = terms.start.len();
    assert_eq!(words(&terms), 0);
    let gradient = vec![Vector::zeros(); nodes];
    assert_eq!(words(&NewtonStep { gradient: &gradient, ..terms }), 9 * nodes);
    let scalars: Vec<f64> = terms.scalars.iter().map(|value| 2.0 * value).collect();
    assert!(!scalars.is_empty());
    assert!(words(&NewtonStep { gradient: &gradient, scalars: &scalars, ..terms }) > 4 * nodes);
}

/// What does not move has no change of energy, whatever its shape.
#[test]
fn nothing_changes_where_nothing_moves() {
    for case in cases() {
        let problem = Problem::new(&case, STRONG, 5);
        let mut run = Run::new(TwinEngine::new(), &problem);
        let found = run.energies(&problem, &problem.reference, &problem.reference);
        assert_eq!([found.change, found.rounding], [0.0; 2], "{}", problem.name);
    }
}

#[test]
fn kernels_compute_the_potential_as_their_twins() {
    for case in cases() {
        let problem = Problem::new(&case, STRONG, 6);
        let mut run = Run::new(ComparingEngine::new(device()), &problem);
        run.gradient_words(&problem, &problem.reference);
        run.energy_words(&problem, &problem.reference, &problem.trial);
        let differences = run.engine.differences();
        assert!(differences.is_empty(), "{}: {:?}", problem.name, &differences[..1]);
        assert!(run.engine.words_compared() > 1000, "{}", problem.name);
    }
}

#[test]
fn two_runs_on_a_device_have_the_same_bits() {
    let problem = Problem::new(&cases()[3], STRONG, 7);
    let [first, second] = [0, 1].map(|_| {
        let mut run = Run::new(device(), &problem);
        let gradient = run.gradient_words(&problem, &problem.reference);
        let energies = run.energy_words(&problem, &problem.reference, &problem.trial);
        run.potential.free(&mut run.engine);
        (gradient, energies)
    });
    assert!(first == second && first.0.iter().any(|word| *word != 0));
}
