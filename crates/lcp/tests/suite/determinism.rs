//! The same bits on any number of threads, and as the serial solver.
#![allow(clippy::unwrap_used)] // helpers outside the test functions

use crate::common::{Case, cloth};
use bowknot_lcp::*;
use nalgebra::Vector2;

/// A friction row for each row, in the same colors.
fn rubbing(case: &Case) -> Vec<FrictionRow> {
    let mut friction: Vec<FrictionRow> = case
        .rows
        .iter()
        .enumerate()
        .map(|(normal, row)| {
            let n = row.gradients[0].normalize();
            let t = n.cross(&Vector::x()).normalize();
            FrictionRow {
                tangents: [t, n.cross(&t)],
                coefficients: row.gradients.map(|g| g.dot(&n)),
                offsets: [0.001, -0.002],
                vertices: row.vertices,
                friction: 0.3,
                inverse_diagonal: f64::NAN,
                normal: normal as u32,
            }
        })
        .collect();
    prepare_friction(&mut friction, &case.weights).unwrap();
    friction
}

/// All bits of the state after `solve`, and of its residual.
fn bits(
    problem: &LcpProblem<'_>,
    case: &Case,
    solve: impl Fn(&mut LcpState<'_>) -> LcpInfo + Sync + Send,
) -> Vec<u64> {
    let (mut y, mut lambda, mut limit_multipliers) = case.start();
    let mut friction = vec![Vector2::zeros(); problem.friction().rows.len()];
    let mut state = LcpState {
        y: &mut y,
        lambda: &mut lambda,
        limit_multipliers: &mut limit_multipliers,
        friction: &mut friction,
    };
    let residual = solve(&mut state).residual;
    assert!(residual > 0.0);
    let reals = y.iter().chain(&limit_multipliers).flat_map(|v| [v.x, v.y, v.z]);
    let reals = reals.chain(friction.iter().flat_map(|v| [v.x, v.y])).chain(lambda).chain([residual]);
    reals.map(f64::to_bits).collect()
}

#[test]
fn results_have_the_same_bits_on_any_number_of_threads() {
    let case = cloth(60, 6000, 5);
    let friction = rubbing(&case);
    // Every third row is left out.
    let (mut order, mut starts) = (Vec::new(), vec![0]);
    for ends in case.row_starts.windows(2) {
        order.extend((ends[0]..ends[1]).filter(|r| r % 3 != 0));
        starts.push(order.len() as u32);
    }
    let all = Schedule::colored(&case.row_starts);
    let params = LcpParams { max_sweeps: 5, ..LcpParams::default() };
    for schedule in [all, Schedule::active(&order, &starts)] {
        let problem = LcpProblem::new(
            &case.weights,
            ConstraintSet::new(&case.rows, schedule),
            ConstraintSet::new(&case.limits, Schedule::colored(&case.limit_starts)),
            ConstraintSet::new(&friction, schedule),
        )
        .unwrap();
        validate_colors(&problem).unwrap();
        let serial = bits(&problem, &case, |state| solve_serial(&problem, state, &params).unwrap());
        let jacobi = |state: &mut LcpState<'_>| Jacobi::new().solve(&problem, state, &params).unwrap();
        let simultaneous = bits(&problem, &case, jacobi);
        for threads in [1, 2, 3, 5, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for _ in 0..5 {
                let colored = pool.install(|| {
                    bits(&problem, &case, |state| solve_colored(&problem, state, &params).unwrap())
                });
                assert!(colored == serial, "{threads} threads");
            }
            assert!(pool.install(|| bits(&problem, &case, jacobi)) == simultaneous, "{threads} threads");
        }
    }
}

#[test]
fn a_solver_that_keeps_its_memory_gives_the_same_bits() {
    let cases = [cloth(60, 6000, 9), cloth(40, 3000, 4)];
    let params = LcpParams { max_sweeps: 8, ..LcpParams::default() };
    for threads in [1, 2, 3, 8] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let solver = std::sync::Mutex::new(GaussSeidel::new());
        for case in cases.iter().chain(&cases) {
            let problem = LcpProblem::new(
                &case.weights,
                ConstraintSet::new(&case.rows, Schedule::colored(&case.row_starts)),
                ConstraintSet::new(&case.limits, Schedule::colored(&case.limit_starts)),
                ConstraintSet::default(),
            )
            .unwrap();
            let serial = bits(&problem, case, |state| solve_serial(&problem, state, &params).unwrap());
            let kept = pool.install(|| {
                bits(&problem, case, |state| solver.lock().unwrap().solve(&problem, state, &params).unwrap())
            });
            assert!(kept == serial, "{threads} threads");
        }
    }
}

#[test]
fn single_sweeps_add_up_to_a_solve() {
    let case = cloth(40, 3000, 6);
    let problem = LcpProblem::new(
        &case.weights,
        ConstraintSet::new(&case.rows, Schedule::colored(&case.row_starts)),
        ConstraintSet::new(&case.limits, Schedule::colored(&case.limit_starts)),
        ConstraintSet::default(),
    )
    .unwrap();
    let params = LcpParams { max_sweeps: 4, ..LcpParams::default() };
    let solved = bits(&problem, &case, |state| solve_colored(&problem, state, &params).unwrap());
    let swept = bits(&problem, &case, |state| {
        for _ in 0..3 {
            sweep_colored(&problem, state, &params).unwrap();
        }
        solve_serial(&problem, state, &LcpParams { max_sweeps: 1, ..params }).unwrap()
    });
    let stopped = bits(&problem, &case, |state| {
        let Err(LcpError::NotConverged { sweeps: 4, residual }) =
            solve_colored(&problem, state, &LcpParams { tolerance: Some(0.0), ..params })
        else {
            panic!("four sweeps cannot be exact")
        };
        LcpInfo { sweeps: 4, residual }
    });
    assert!(solved == swept && solved == stopped);
}

#[test]
fn friction_attached_to_its_normals_has_the_same_bits_and_the_same_solution() {
    let case = cloth(60, 6000, 5);
    let mut friction = rubbing(&case);
    // Every other contact is rough; rows stay in order.
    friction.retain(|f| f.normal % 2 == 0);
    let mut friction_of = vec![LcpProblem::NO_FRICTION; case.rows.len()];
    friction.iter().enumerate().for_each(|(f, row)| friction_of[row.normal as usize] = f as u32);
    let problem = LcpProblem::new(
        &case.weights,
        ConstraintSet::new(&case.rows, Schedule::colored(&case.row_starts)),
        ConstraintSet::new(&case.limits, Schedule::colored(&case.limit_starts)),
        ConstraintSet::serial(&friction),
    )
    .unwrap();
    let attached = problem.attach_friction(&friction_of).unwrap();
    let params = LcpParams { max_sweeps: 5, ..LcpParams::default() };
    let serial = bits(&attached, &case, |state| solve_serial(&attached, state, &params).unwrap());
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let colored = pool
            .install(|| bits(&attached, &case, |state| solve_colored(&attached, state, &params).unwrap()));
        assert!(colored == serial, "{threads} threads");
    }
    let after_all = bits(&problem, &case, |state| solve_serial(&problem, state, &params).unwrap());
    assert!(after_all != serial, "attached rows are swept in another order");
    // Each friction row was swept: many multipliers are not 0.
    let (mut y, mut lambda, mut limit_multipliers) = case.start();
    let mut multipliers = vec![Vector2::zeros(); friction.len()];
    let mut state = LcpState {
        y: &mut y,
        lambda: &mut lambda,
        limit_multipliers: &mut limit_multipliers,
        friction: &mut multipliers,
    };
    sweep_colored(&attached, &mut state, &params).unwrap();
    assert!(multipliers.iter().filter(|m| **m != Vector2::zeros()).count() > 100);
}

#[test]
fn friction_that_does_not_belong_to_its_row_is_refused() {
    let case = cloth(8, 20, 1);
    let friction = rubbing(&case);
    let family = ConstraintSet::serial(&friction[..]);
    let problem =
        LcpProblem::new(&case.weights, ConstraintSet::serial(&case.rows), ConstraintSet::default(), family)
            .unwrap();
    let mut friction_of: Vec<u32> = (0..case.rows.len() as u32).collect();
    assert!(problem.attach_friction(&friction_of).is_ok());
    assert!(matches!(problem.attach_friction(&friction_of[1..]), Err(LcpError::Length { .. })));
    friction_of.swap(0, 1);
    assert_eq!(
        problem.attach_friction(&friction_of).unwrap_err(),
        LcpError::Attached { row: 0, friction: 1 }
    );
    friction_of[0] = 1000;
    assert_eq!(
        problem.attach_friction(&friction_of).unwrap_err(),
        LcpError::Attached { row: 0, friction: 1000 }
    );
}
