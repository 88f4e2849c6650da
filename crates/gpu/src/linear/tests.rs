//! Solves of random systems, on the twins and on a device, against dense algebra in double precision.

mod systems;

use super::galerkin::Multilevel;
use super::layout::{CHILDREN, DOMAIN_UNKNOWNS, PATCH_SLOTS};
use super::patches::Patches;
use crate::adapter::Adapter;
use crate::engine::{ComparingEngine, DeviceEngine, Engine, TwinEngine};
use crate::error::GpuError;
use crate::linear::ConjugateGradients;
use crate::recording::{BufferId, Recording};
use bowknot_dynamics::{LinearBackend, LinearSystem};
use bowknot_geometry::Vector;
use nalgebra::{DMatrix, DVector};
use std::fmt::Debug;
use systems::{Owned, Shape};

/// Share of the right-hand side that refinement leaves, in the norm of the preconditioner.
const TOLERANCE: f64 = 1e-7;

const PLAIN: Shape =
    Shape { columns: 1, rows: 1, patch: 0, springs: 0, grains: 0, jitter: 0.3, inertia: 1.0, held: 7 };

/// Systems with everything that a device distinguishes: no patch with groups, one, up to eight, more; springs; grains.
const SHAPES: [Shape; 6] = [
    Shape { columns: 1, rows: 1, patch: 40, springs: 0, grains: 0, ..PLAIN },
    Shape { columns: 5, rows: 7, patch: 0, springs: 5, grains: 3, ..PLAIN },
    Shape { columns: 7, rows: 6, patch: 42, springs: 0, grains: 0, ..PLAIN },
    Shape { columns: 12, rows: 13, patch: 50, springs: 30, grains: 70, ..PLAIN },
    Shape { columns: 24, rows: 23, patch: 30, springs: 60, grains: 5, ..PLAIN },
    Shape { columns: 20, rows: 20, patch: 150, springs: 10, grains: 0, ..PLAIN },
];

/// Many small patches, which make four and five coarse levels.
const FOUR_LEVELS: Shape = Shape { columns: 30, rows: 35, patch: 2, springs: 20, held: 0, ..PLAIN };
const FIVE_LEVELS: Shape = Shape { columns: 64, rows: 130, patch: 2, springs: 20, held: 0, ..PLAIN };

fn solver<E: Engine>(engine: E) -> ConjugateGradients<E> {
    ConjugateGradients::new("test".to_owned(), engine)
}

fn device() -> DeviceEngine {
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    DeviceEngine::open(&adapter).unwrap_or_else(|error| panic!("{error}"))
}

/// Solves with refinement in double precision; returns x and the iterations of each round.
fn refined<E: Engine + Debug + Send>(
    solver: &mut ConjugateGradients<E>,
    system: &LinearSystem<'_>,
    b: &[Vector],
) -> (Vec<Vector>, Vec<usize>) {
    let matrix = systems::dense(system);
    let mut x = vec![Vector::zeros(); b.len()];
    let mut iterations = Vec::new();
    solver.prepare(system).expect("room");
    let scale = solver.begin(b, 1.0).expect("runs");
    let (mut r, mut norm, mut factor) = (b.to_vec(), scale, 1.0f64);
    while norm > TOLERANCE * TOLERANCE * scale {
        assert!(iterations.len() < 6, "the residual is still {:e} of b", (norm / scale).sqrt());
        let goal = 0.9 * TOLERANCE * TOLERANCE * scale * factor * factor;
        iterations.push(solver.iterate(goal, 2000, 1.0 / factor, &mut x).expect("runs"));
        r = systems::residual(&matrix, &x, b);
        factor = 1.0 / r.iter().map(Vector::amax).fold(f64::MIN_POSITIVE, f64::max);
        norm = solver.begin(&r, factor).expect("runs") / (factor * factor);
    }
    assert!(r.iter().all(|r| r.iter().all(|r| r.is_finite())));
    (x, iterations)
}

#[test]
fn random_systems_are_solved_as_by_dense_algebra() {
    for (seed, shape) in SHAPES.iter().enumerate() {
        let owned = Owned::random(shape, seed as u64);
        let system = owned.system();
        let b = owned.right_side(seed as u64);
        let (x, iterations) = refined(&mut solver(TwinEngine::new()), &system, &b);
        let expected = systems::solve(&system, &b);
        let error = x.iter().zip(&expected).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
        let size = expected.iter().map(|x| x.norm()).fold(0.0, f64::max);
        // The condition number of these matrices is below 1e4.
        assert!(error <= 1e-4 * size, "{shape:?}: {error:e} of {size:e}");
        assert!(x.iter().zip(system.free).all(|(x, free)| *free || *x == Vector::zeros()), "{shape:?}");
        // A round in single precision takes away five digits, and the last one little.
        assert!(iterations.len() <= 3, "{shape:?}: {iterations:?}");
    }
}

fn patches_of(system: &LinearSystem<'_>) -> Patches {
    Patches::new(system.free, system.positions, system.patches)
}

/// M r of the preconditioner: the columns of M are read from the squared norms of vectors, r . M r.
fn preconditioner(system: &LinearSystem<'_>) -> DMatrix<f64> {
    let count = system.free.len();
    let mut solver = solver(TwinEngine::new());
    solver.prepare(system).expect("room");
    let mut norm = |entries: &[(usize, f64)]| {
        let mut r = vec![Vector::zeros(); count];
        entries.iter().filter(|(k, _)| system.free[k / 3]).for_each(|&(k, value)| r[k / 3][k % 3] += value);
        solver.begin(&r, 1.0).expect("runs")
    };
    let diagonal: Vec<f64> = (0..3 * count).map(|k| norm(&[(k, 1.0)])).collect();
    DMatrix::from_fn(3 * count, 3 * count, |i, j| {
        if i == j { diagonal[i] } else { 0.5 * (norm(&[(i, 1.0), (j, 1.0)]) - diagonal[i] - diagonal[j]) }
    })
}

/// The rigid motions of the groups of a domain, as columns over the components of its nodes, and the inverse of their matrix.
/// Of a node of block-Jacobi the columns are its components.
struct Correction {
    nodes: Vec<u32>,
    motions: DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl Correction {
    /// P (P^T A P)^-1 P^T r over the components of the nodes.
    fn of(&self, r: &DVector<f64>) -> DVector<f64> {
        &self.motions * (&self.inverse * self.motions.tr_mul(r))
    }

    fn components(&self) -> Vec<usize> {
        self.nodes.iter().flat_map(|&node| (0..3).map(move |c| 3 * node as usize + c)).collect()
    }
}

/// The terms P (P^T A P)^-1 P^T of all levels and domains, and block-Jacobi, from the definition.
fn corrections(system: &LinearSystem<'_>, patches: &Patches) -> Vec<Correction> {
    let matrix = systems::dense(system);
    let free = (0..system.free.len()).filter(|n| system.free[*n]);
    let mut corrections: Vec<Correction> = free
        .map(|node| {
            let block = matrix.view((3 * node, 3 * node), (3, 3)).into_owned();
            let inverse = block.try_inverse().expect("definite");
            Correction { nodes: vec![node as u32], motions: DMatrix::identity(3, 3), inverse }
        })
        .collect();
    // Groups of the finest level, as lists of nodes; those of the next level join eight of them.
    let mut groups: Vec<Vec<u32>> = (0..CHILDREN * patches.grouped)
        .map(|g| patches.slots[CHILDREN * g..][..CHILDREN].iter().flatten().copied().collect())
        .collect();
    while groups.len() > 1 {
        for domain in groups.chunks(CHILDREN) {
            let nodes = domain.concat();
            let mut motions = DMatrix::zeros(3 * nodes.len(), 6 * domain.len());
            let mut row = 0;
            for (g, group) in domain.iter().enumerate() {
                let points = || group.iter().map(|&node| system.positions[node as usize]);
                let center = points().sum::<Vector>() / points().count().max(1) as f64;
                for at in points() {
                    for k in 0..6 {
                        let axis = Vector::ith(k % 3, 1.0);
                        let motion = if k < 3 { axis } else { axis.cross(&(at - center)) };
                        motions.fixed_view_mut::<3, 1>(row, 6 * g + k).copy_from(&motion);
                    }
                    row += 3;
                }
            }
            let mut correction = Correction { nodes, motions, inverse: DMatrix::zeros(0, 0) };
            let components = correction.components();
            let own = matrix.select_columns(&components).select_rows(&components);
            // Motions that move nothing of their own have eigenvalues near zero.
            let eigen = (correction.motions.transpose() * own * &correction.motions).symmetric_eigen();
            let largest = eigen.eigenvalues.max();
            let inverse =
                eigen.eigenvalues.map(|value| if value > 1e-7 * largest { 1.0 / value } else { 0.0 });
            correction.inverse =
                &eigen.eigenvectors * DMatrix::from_diagonal(&inverse) * eigen.eigenvectors.transpose();
            corrections.push(correction);
        }
        groups = groups.chunks(CHILDREN).map(|domain| domain.concat()).collect();
    }
    corrections
}

/// Their sum.
fn preconditioner_by_definition(system: &LinearSystem<'_>, patches: &Patches) -> DMatrix<f64> {
    let count = 3 * system.free.len();
    let mut sum = DMatrix::zeros(count, count);
    for correction in corrections(system, patches) {
        let components = correction.components();
        let term = &correction.motions * &correction.inverse * correction.motions.transpose();
        for (j, &column) in components.iter().enumerate() {
            for (i, &row) in components.iter().enumerate() {
                sum[(row, column)] += term[(i, j)];
            }
        }
    }
    sum
}

/// r . M r on the twins and by definition, for some vectors r.
fn assert_norms(owned: &Owned, patches: &Patches, accuracy: f64) {
    let system = owned.system();
    let terms = corrections(&system, patches);
    let mut solver = solver(TwinEngine::new());
    solver.prepare(&system).expect("room");
    for seed in 0..5 {
        let r = owned.right_side(seed);
        let norm: f64 = terms
            .iter()
            .map(|term| {
                let nodes = term.nodes.iter().map(|&node| r[node as usize]);
                let own = DVector::from_iterator(3 * term.nodes.len(), nodes.flat_map(|v| [v.x, v.y, v.z]));
                own.dot(&term.of(&own))
            })
            .sum();
        let found = solver.begin(&r, 1.0).expect("runs");
        assert!((found - norm).abs() < accuracy * norm, "{found:e}, not {norm:e}");
    }
}

#[test]
fn the_preconditioner_is_the_sum_over_levels() {
    // Three patches with groups, one with a single group of few nodes, and grains.
    let shape = Shape { columns: 9, rows: 14, patch: 45, springs: 20, grains: 3, ..PLAIN };
    let owned = Owned::random(&shape, 11);
    let system = owned.system();
    let patches = patches_of(&system);
    assert!(patches.grouped > 2 && patches.levels == [patches.grouped], "{patches:?}");
    let found = preconditioner(&system);
    let expected = preconditioner_by_definition(&system, &patches);
    let (error, size) = ((found - &expected).abs().max(), expected.abs().max());
    assert!(error < 2e-5 * size, "{error:e} of {size:e}");
}

/// The spin of a strand that is nearly straight about itself moves next to nothing: in single precision the force on it is
/// rounding.
#[test]
fn straight_strands_do_not_spin_about_themselves() {
    let shape = Shape { columns: 1, rows: 150, patch: 64, jitter: 1e-5, held: 0, ..PLAIN };
    let owned = Owned::random(&shape, 5);
    let system = owned.system();
    assert_norms(&owned, &patches_of(&system), 1e-5);
}

/// Four coarse levels are made by one dispatch, in which no level waits for another.
#[test]
fn the_preconditioner_has_four_coarse_levels() {
    let owned = Owned::random(&FOUR_LEVELS, 6);
    let patches = patches_of(&owned.system());
    assert_eq!(patches.levels, [525, 66, 9, 2]);
    assert_norms(&owned, &patches, 2e-5);
}

/// The fifth level is made by the next dispatch.
#[test]
#[ignore = "takes a minute; kernels and twins are compared in every_kernel_computes_what_its_twin_computes"]
fn the_preconditioner_has_five_coarse_levels() {
    let owned = Owned::random(&FIVE_LEVELS, 6);
    let patches = patches_of(&owned.system());
    assert_eq!(patches.levels, [4160, 520, 65, 9, 2]);
    assert_norms(&owned, &patches, 2e-5);
}

#[test]
fn patches_hold_each_free_node_once() {
    for (seed, shape) in SHAPES.iter().enumerate() {
        let owned = Owned::random(shape, seed as u64);
        let system = owned.system();
        let patches = patches_of(&system);
        let mut seen: Vec<u32> = patches.slots.iter().flatten().copied().collect();
        seen.sort_unstable();
        let free: Vec<u32> = (0..system.free.len() as u32).filter(|n| system.free[*n as usize]).collect();
        assert_eq!(seen, free, "{shape:?}");
        assert_eq!(patches.slots.len() % PATCH_SLOTS, 0);
        let domains = Multilevel::new(&system, &patches).domains;
        let above: usize = patches.levels.iter().map(|groups| groups.div_ceil(CHILDREN)).sum();
        assert_eq!(domains.len(), patches.grouped + above, "{shape:?}");
        let is_finite = |number: &f32| number.is_finite();
        assert!(domains.iter().all(|d| d.inverse.iter().all(is_finite)), "{shape:?}");
        for d in &domains {
            let transposed = |k: usize| DOMAIN_UNKNOWNS * (k % DOMAIN_UNKNOWNS) + k / DOMAIN_UNKNOWNS;
            assert!((0..d.inverse.len()).all(|k| d.inverse[k] == d.inverse[transposed(k)]), "not symmetric");
        }
    }
}

#[test]
fn every_kernel_computes_what_its_twin_computes() {
    for (seed, shape) in SHAPES.iter().chain([&FOUR_LEVELS, &FIVE_LEVELS]).enumerate() {
        let owned = Owned::random(shape, seed as u64);
        let system = owned.system();
        let mut solver = solver(ComparingEngine::new(device()));
        solver.prepare(&system).expect("room");
        let norm = solver.begin(&owned.right_side(3), 1.0).expect("runs");
        let mut x = vec![Vector::zeros(); system.free.len()];
        solver.iterate(1e-4 * norm, 40, 1.0, &mut x).expect("runs");
        let engine = solver.engine();
        assert!(engine.differences().is_empty(), "{shape:?}: {:?}", &engine.differences()[..1]);
        assert!(engine.words_compared() > 100, "{shape:?}");
    }
}

#[test]
fn a_device_solves_as_the_twins_and_repeats_itself() {
    let owned = Owned::random(&SHAPES[4], 4);
    let (system, b) = (owned.system(), owned.right_side(4));
    let (twins, _) = refined(&mut solver(TwinEngine::new()), &system, &b);
    let [first, second] = [(); 2].map(|()| refined(&mut solver(device()), &system, &b));
    assert!(first == second);
    let error = twins.iter().zip(&first.0).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
    let size = twins.iter().map(|x| x.norm()).fold(0.0, f64::max);
    assert!(error <= 1e-4 * size, "{error:e} of {size:e}");
}

#[test]
fn buffers_are_used_again_and_grow() {
    let mut solver = solver(TwinEngine::new());
    for k in [2, 4, 0, 3, 1, 5] {
        let owned = Owned::random(&SHAPES[k], 20 + k as u64);
        let (system, b) = (owned.system(), owned.right_side(k as u64));
        let alone = refined(&mut super::tests::solver(TwinEngine::new()), &system, &b);
        assert!(refined(&mut solver, &system, &b) == alone, "{:?}", SHAPES[k]);
    }
}

/// The twins, and how much the host asks of them.
#[derive(Debug, Default)]
struct Counting {
    twins: TwinEngine,
    dispatches: usize,
    runs: usize,
    words_read: usize,
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
        self.dispatches += recording.dispatch_count();
        self.runs += 1;
        self.words_read += read.iter().map(|(_, words)| words).sum::<usize>();
        self.twins.run(recording, read)
    }
}

/// Dispatches of an iteration, and what the host reads for 16 of them beside the solution: the figures of `docs/gpu/dynamics.md`.
#[test]
fn an_iteration_takes_few_dispatches() {
    let springs = 10;
    for (rows, patch, springs, expected) in [
        (35, 2, 0, 4),
        (300, 2, 0, 5),
        (30, 0, 0, 3),
        (30, 0, springs, 3),
        (2, 60, 0, 3),
        (10, 60, 0, 4),
        (30, 50, 0, 4),
        (30, 50, springs, 4),
    ] {
        let shape = Shape { columns: 30, rows, patch, springs, ..PLAIN };
        let owned = Owned::random(&shape, 2);
        let (system, b) = (owned.system(), owned.right_side(2));
        let mut solver = solver(Counting::default());
        solver.prepare(&system).expect("room");
        let mut count = |iterations: usize| {
            solver.begin(&b, 1.0).expect("runs");
            let before = (solver.engine().dispatches, solver.engine().runs, solver.engine().words_read);
            let mut x = vec![Vector::zeros(); b.len()];
            assert_eq!(solver.iterate(0.0, iterations, 1.0, &mut x).expect("runs"), iterations);
            let engine = solver.engine();
            (engine.dispatches - before.0, engine.runs - before.1, engine.words_read - before.2)
        };
        assert_eq!(count(1), (expected, 2, 2 + 4 * b.len()), "{shape:?}");
        assert_eq!(count(16), (16 * expected, 2, 2 + 4 * b.len()), "{shape:?}");
    }
}

#[test]
fn groups_save_iterations() {
    let shape = Shape { columns: 40, rows: 40, inertia: 0.01, held: 0, ..PLAIN };
    let count = |patch: usize| {
        let owned = Owned::random(&Shape { patch, ..shape }, 7);
        let (system, b) = (owned.system(), owned.right_side(7));
        let mut solver = solver(TwinEngine::new());
        solver.prepare(&system).expect("room");
        let norm = solver.begin(&b, 1.0).expect("runs");
        let mut x = vec![Vector::zeros(); b.len()];
        solver.iterate(1e-8 * norm, 2000, 1.0, &mut x).expect("runs")
    };
    let [jacobi, groups] = [0, 60].map(count);
    assert!(2 * groups < jacobi && groups > 0, "{groups} and {jacobi}");
}

#[test]
fn units_make_no_difference() {
    // Powers of two change no digit.
    let count = |factor: f64| {
        let owned = Owned::random(&SHAPES[4], 8).scaled(factor);
        let b = owned.right_side(8);
        let (x, iterations) = refined(&mut solver(TwinEngine::new()), &owned.system(), &b);
        (x.iter().map(|x| x * factor).collect::<Vec<_>>(), iterations)
    };
    let one = count(1.0);
    for exponent in [-40, 40] {
        assert!(count(2f64.powi(exponent)) == one, "{exponent}");
    }
}

#[test]
fn numbers_that_are_not_finite_end_a_solve() {
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        let owned = Owned::random(&SHAPES[4], 9).spoiled(value);
        let b = owned.right_side(9);
        let system = owned.system();
        assert!(iterations(&mut solver(TwinEngine::new()), &system, &b) < 1000, "{value}");
        assert!(iterations(&mut solver(device()), &system, &b) < 1000, "{value}");
    }
}

#[test]
fn without_free_nodes_there_is_nothing_to_solve() {
    for shape in [SHAPES[1], SHAPES[3], Shape { rows: 0, ..PLAIN }] {
        let owned = Owned::random(&shape, 2).held();
        let b = owned.right_side(2);
        assert_eq!(iterations(&mut solver(TwinEngine::new()), &owned.system(), &b), 0, "{shape:?}");
        assert_eq!(iterations(&mut solver(device()), &owned.system(), &b), 0, "{shape:?}");
    }
}

/// Iterations toward a residual of zero, 1000 at most.
fn iterations<E: Engine + Debug + Send>(
    solver: &mut ConjugateGradients<E>,
    system: &LinearSystem<'_>,
    b: &[Vector],
) -> usize {
    let mut x = vec![Vector::zeros(); b.len()];
    solver.prepare(system).expect("room");
    solver.begin(b, 1.0).expect("runs");
    solver.iterate(0.0, 1000, 1.0, &mut x).expect("runs")
}

#[test]
fn limits_of_iterations_are_kept_and_nothing_is_no_work() {
    let owned = Owned::random(&SHAPES[4], 1);
    let (system, b) = (owned.system(), owned.right_side(1));
    let mut solver = solver(TwinEngine::new());
    solver.prepare(&system).expect("room");
    let mut x = vec![Vector::zeros(); b.len()];
    for limit in [1, 16, 17] {
        solver.begin(&b, 1.0).expect("runs");
        assert_eq!(solver.iterate(0.0, limit, 1.0, &mut x).expect("runs"), limit);
    }
    let zero = vec![Vector::zeros(); b.len()];
    assert_eq!(solver.begin(&zero, 1.0).expect("runs"), 0.0);
    x.fill(Vector::zeros());
    assert_eq!(solver.iterate(0.0, 50, 1.0, &mut x).expect("runs"), 0);
    assert_eq!(x, zero);
    // Rounding ends the iterations long before the limit.
    solver.begin(&b, 1.0).expect("runs");
    assert!(solver.iterate(0.0, 5000, 1.0, &mut x).expect("runs") < 500);
}
