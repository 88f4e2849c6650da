//! The preconditioner beside its definition, and what it costs and saves.

use super::fixture::{Fixture, LIMITS, fixtures, flat, masked, matrix, solver};
use crate::engine::{Engine, TwinEngine};
use crate::linear::{CHILDREN, ConjugateGradients, PATCH_SLOTS, Patches};
use crate::recording::Recording;
use bowknot_dynamics::NewtonBackend;
use bowknot_geometry::Vector;
use nalgebra::{DMatrix, DVector};

/// The inverses of domains are shifted by 4e-6 of their diagonals, which acts on bodies that are stiffer than
/// their inertia.
const SHIFT: f64 = 1e-3;

/// Motions of a domain, as columns over the components of its nodes, and the inverse of their matrix. Of a
/// node of block-Jacobi the columns are its components.
struct Correction {
    nodes: Vec<u32>,
    motions: DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl Correction {
    /// r . P (P^T A P)^-1 P^T r over the components of the nodes.
    fn squared_norm(&self, r: &DVector<f64>) -> f64 {
        let components = components(&self.nodes);
        let r = DVector::from_iterator(components.len(), components.into_iter().map(|k| r[k]));
        let forces = self.motions.tr_mul(&r);
        forces.dot(&(&self.inverse * &forces))
    }
}

fn components(nodes: &[u32]) -> Vec<usize> {
    nodes.iter().flat_map(|&node| (0..3).map(move |c| 3 * node as usize + c)).collect()
}

/// The terms P (P^T A P)^-1 P^T of all levels and domains, and block-Jacobi, from the definition.
fn corrections(
    matrix: &DMatrix<f64>,
    positions: &[Vector],
    free: &[bool],
    patches: &Patches,
) -> Vec<Correction> {
    let nodes = (0..free.len()).filter(|n| free[*n]);
    let mut corrections: Vec<Correction> = nodes
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
                let points = || group.iter().map(|&node| positions[node as usize]);
                let center = points().sum::<Vector>() / points().count().max(1) as f64;
                for at in points() {
                    for k in 0..6 {
                        let axis = Vector::ith(k % 3, 1.0);
                        // Spins in units of about the size of a group.
                        let motion = if k < 3 { axis } else { axis.cross(&(at - center)) * 20.0 };
                        motions.fixed_view_mut::<3, 1>(row, 6 * g + k).copy_from(&motion);
                    }
                    row += 3;
                }
            }
            let rows = components(&nodes);
            let own = matrix.select_columns(&rows).select_rows(&rows);
            // Motions that move nothing of their own have eigenvalues near zero.
            let eigen = (motions.transpose() * own * &motions).symmetric_eigen();
            let largest = eigen.eigenvalues.max();
            let inverse =
                eigen.eigenvalues.map(|value| if value > 1e-6 * largest { 1.0 / value } else { 0.0 });
            let inverse =
                &eigen.eigenvectors * DMatrix::from_diagonal(&inverse) * eigen.eigenvectors.transpose();
            corrections.push(Correction { nodes, motions, inverse });
        }
        groups = groups.chunks(CHILDREN).map(|domain| domain.concat()).collect();
    }
    corrections
}

/// Begins a target and solves, which makes the preconditioner. Returns the iterate and the number of
/// iterations.
fn solve(fixture: &Fixture, solver: &mut ConjugateGradients<TwinEngine>) -> (Vec<Vector>, usize) {
    let x = fixture.begin(solver);
    solver.linearize(false).expect("runs");
    let solved = solver.solve(&fixture.springs(), &LIMITS).expect("runs");
    assert!(solved.info.converged, "{}: {solved:?}", fixture.name);
    (x, solved.info.iterations)
}

/// r . M r of the preconditioner of the last solve.
fn squared_norm(solver: &mut ConjugateGradients<TwinEngine>, r: &DVector<f64>) -> f64 {
    let (newton, recorder) = (solver.newton.as_ref().expect("one"), solver.recorder.clone().expect("one"));
    let r: Vec<[f32; 4]> =
        r.as_slice().chunks(3).map(|r| [r[0] as f32, r[1] as f32, r[2] as f32, 0.0]).collect();
    let mut recording = Recording::default();
    newton.record_before(&mut recording);
    recording.write(recorder.buffers.direction, &r);
    newton.outside(&recorder).record_residual(0, &mut recording);
    let norms = recorder.norms(0);
    let read = solver.engine.run(&recording, &[(recorder.buffers.sums, norms.end)]).expect("runs");
    read[0][norms].iter().map(|bits| f64::from(f32::from_bits(*bits))).sum()
}

/// Norms of smooth and rough vectors on the twins are those of the definition up to a share `most`. Returns
/// the number of coarse levels.
fn assert_norms(fixture: &Fixture, most: f64) -> usize {
    let mut solver = solver(TwinEngine::new(), fixture);
    let (x, _) = solve(fixture, &mut solver);
    let h = matrix(&mut solver);
    let set = solver.assembly.as_ref().and_then(|assembly| assembly.set.as_ref());
    let patches = &set.expect("one").patches;
    let (levels, terms) = (patches.levels.len(), corrections(&h, &x, &fixture.free, patches));
    for width in [1, 4, 16, 64, 256] {
        let random = &mut fastrand::Rng::with_seed(width as u64);
        let entry = |k: usize| Vector::new(1.0, 0.3, -0.5) * (k % width) as f64 / width as f64;
        let noise = |random: &mut fastrand::Rng| Vector::from_fn(|_, _| 2.0 * random.f64() - 1.0) * 0.2;
        let r: Vec<Vector> = (0..x.len()).map(|k| entry(k) + noise(random)).collect();
        let r = masked(&flat(&r), &fixture.free);
        let expected: f64 = terms.iter().map(|term| term.squared_norm(&r)).sum();
        let found = squared_norm(&mut solver, &r);
        println!("{}, {levels} levels: {:.1e}", fixture.name, found / expected - 1.0);
        assert!((found / expected - 1.0).abs() < most, "{}: {found} and {expected}", fixture.name);
    }
    levels
}

#[test]
fn norms_are_those_of_the_sum_over_levels() {
    let levels: Vec<usize> = fixtures().iter().map(|fixture| assert_norms(fixture, SHIFT)).collect();
    assert!(levels.contains(&0) && levels.contains(&1), "{levels:?}");
}

/// Three coarse levels are made by one dispatch, in which no level waits for another, and the fourth by the
/// next one.
#[test]
fn there_may_be_four_coarse_levels() {
    let mut fixture = Fixture::of_cloth(32);
    let nodes = fixture.free.len() as u32;
    // A patch each.
    fixture.model.patches = (0..nodes.div_ceil(2)).map(|k| 2 * k..(2 * k + 2).min(nodes)).collect();
    assert_eq!(assert_norms(&fixture, SHIFT), 4);
}

/// The spin of a strand that is nearly straight about itself moves next to nothing: in single precision the
/// force on it is rounding, which made norms wrong by orders of magnitude. The definition, as it is computed
/// here, leaves soft motions out.
#[test]
fn straight_strands_do_not_spin_about_themselves() {
    assert_norms(&Fixture::of_strand(150), 4.0);
}

#[test]
fn groups_save_iterations() {
    let mut fixture = Fixture::of_cloth(22);
    let groups = solve(&fixture, &mut solver(TwinEngine::new(), &fixture)).1;
    fixture.model.patches.clear();
    let jacobi = solve(&fixture, &mut solver(TwinEngine::new(), &fixture)).1;
    assert!(3 * groups < 2 * jacobi && groups > 0, "{groups} and {jacobi}");
}

/// Dispatches of an iteration: the figures of `docs/gpu/dynamics.md`.
#[test]
fn an_iteration_takes_few_dispatches() {
    let found = fixtures().into_iter().map(|fixture| {
        let mut solver = solver(TwinEngine::new(), &fixture);
        solve(&fixture, &mut solver);
        let recorder = solver.recorder.as_ref().expect("one");
        let mut recording = Recording::default();
        recorder.record_iteration(0, &mut recording);
        assert_eq!(recording.dispatch_count(), 3 + recorder.sizes.levels.len().div_ceil(3));
        recording.dispatch_count()
    });
    assert_eq!(found.collect::<Vec<_>>(), [3, 4, 4, 4, 3]);
}

#[test]
fn patches_hold_each_free_node_once() {
    let random = &mut fastrand::Rng::with_seed(3);
    for (count, patch) in [(1u32, 40u32), (35, 0), (42, 42), (300, 50), (552, 30), (400, 150)] {
        let positions: Vec<Vector> = (0..count).map(|_| Vector::from_fn(|_, _| random.f64())).collect();
        let free: Vec<bool> = (0..count).map(|k| k % 7 != 3).collect();
        let starts = (0..count).step_by(patch.max(1) as usize).filter(|_| patch > 0);
        let ranges: Vec<_> = starts.map(|start| start..(start + patch).min(count)).collect();
        let patches = Patches::new(&free, &positions, &ranges);
        let mut seen: Vec<u32> = patches.slots.iter().flatten().copied().collect();
        seen.sort_unstable();
        assert_eq!(seen, (0..count).filter(|n| free[*n as usize]).collect::<Vec<_>>());
        assert_eq!(patches.slots.len() % PATCH_SLOTS, 0);
        assert_eq!(patches.grouped > 0, patch > 0 && count > 1);
    }
}
