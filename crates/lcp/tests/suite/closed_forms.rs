//! Small problems whose solutions are known on paper.
#![allow(clippy::unwrap_used)] // helpers outside the test functions

use bowknot_lcp::*;
use nalgebra::Vector2;

const TIGHT: LcpParams = LcpParams {
    max_sweeps: 20_000,
    tolerance: Some(1e-14),
    relaxation: 1.0,
    spectral_radius: 0.0,
    equations: false,
    friction_bound: FrictionBound::Disc,
};

/// Solves distance limits only, from zero multipliers.
fn solve_limits(weights: &[f64], y_free: &[Vector], limits: &[DistanceLimit]) -> (Vec<Vector>, Vec<Vector>) {
    let problem = LcpProblem::new(
        weights,
        ConstraintSet::default(),
        ConstraintSet::serial(limits),
        ConstraintSet::default(),
    )
    .unwrap();
    let (mut y, mut limit_multipliers) = (y_free.to_vec(), vec![Vector::zeros(); limits.len()]);
    let mut state = LcpState { y: &mut y, limit_multipliers: &mut limit_multipliers, ..LcpState::default() };
    solve_serial(&problem, &mut state, &TIGHT).unwrap();
    (y, limit_multipliers)
}

fn limit(a: u32, b: u32, limit: f64) -> DistanceLimit {
    DistanceLimit { vertices: [a, b], limit }
}

#[track_caller]
fn assert_near(a: Vector, b: Vector) {
    assert!((a - b).norm() < 1e-12, "{a:?} against {b:?}");
}

#[test]
fn one_stretched_edge_shrinks_to_its_limit_about_the_centre_of_mass() {
    let weights = [0.5, 2.0];
    let y_free = [Vector::new(3.0, 4.0, 0.0), Vector::zeros()];
    let (y, limit_multipliers) = solve_limits(&weights, &y_free, &[limit(0, 1, 1.0)]);
    let direction = Vector::new(0.6, 0.8, 0.0);
    // |f| = (5 - 1) / (w_a + w_b), towards a.
    assert_near(limit_multipliers[0], direction * 1.6);
    assert_near(y[0], y_free[0] - direction * 0.8);
    assert_near(y[1], direction * 3.2);
}

#[test]
fn a_slack_edge_and_a_pinned_one_stay() {
    let y_free = [Vector::x() * 5.0, Vector::zeros()];
    let (y, limit_multipliers) = solve_limits(&[1.0, 1.0], &y_free, &[limit(0, 1, 5.0)]);
    assert_eq!((y, limit_multipliers), (y_free.to_vec(), vec![Vector::zeros()]));
    let (y, limit_multipliers) = solve_limits(&[0.0, 0.0], &y_free, &[limit(0, 1, 1.0)]);
    assert_eq!((y, limit_multipliers), (y_free.to_vec(), vec![Vector::zeros()]));
    // One end is pinned: the other moves the whole way.
    let (y, _) = solve_limits(&[1.0, 0.0], &y_free, &[limit(0, 1, 1.0)]);
    assert_near(y[0], Vector::x());
    assert_eq!(y[1], y_free[1]);
}

#[test]
fn degenerate_distance_limits_stay_finite() {
    // Coincident nodes, a limit of zero, a node tied to itself, an infinite limit.
    let y_free = [Vector::zeros(), Vector::zeros(), Vector::x()];
    let limits = [limit(0, 1, 0.0), limit(1, 1, 0.0), limit(0, 2, f64::INFINITY), limit(1, 2, 0.0)];
    let (y, limit_multipliers) = solve_limits(&[1.0; 3], &y_free, &limits);
    assert!(y.iter().chain(&limit_multipliers).all(|v| v.iter().all(|c| c.is_finite())));
    // Nodes 0, 1 and 2 are tied into one point, the mean.
    for v in y {
        assert!((v - Vector::x() / 3.0).norm() < 1e-12);
    }
}

#[test]
fn a_hanging_chain_carries_the_sum_of_what_hangs_below() {
    // Pinned at 0, links of length 1, targets at 2, 4, 6: y = 1, 2, 3, and the residual pull of node i is i.
    let weights = [0.0, 1.0, 1.0, 1.0];
    let y_free: Vec<Vector> = (0..4).map(|i| Vector::z() * (-2.0 * f64::from(i))).collect();
    let limits = [limit(0, 1, 1.0), limit(1, 2, 1.0), limit(2, 3, 1.0)];
    let (y, limit_multipliers) = solve_limits(&weights, &y_free, &limits);
    for i in 0..4 {
        assert!((y[i] + Vector::z() * i as f64).norm() < 1e-12);
    }
    for (force, expected) in limit_multipliers.iter().zip([6.0, 5.0, 3.0]) {
        assert!((force.z - expected).abs() < 1e-11, "{force:?}");
    }
}

#[test]
fn kept_multipliers_lead_to_the_same_solution() {
    let weights = [0.0, 1.0, 0.5, 2.0];
    let y_free: Vec<Vector> =
        (0..4).map(|i| Vector::new(f64::from(i) * 2.0, f64::from(i * i), 0.3)).collect();
    let limits = [limit(0, 1, 1.0), limit(1, 2, 1.0), limit(2, 3, 1.0), limit(3, 1, 1.2)];
    let (expected, _) = solve_limits(&weights, &y_free, &limits);
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::default(),
        ConstraintSet::serial(&limits),
        ConstraintSet::default(),
    )
    .unwrap();
    let mut limit_multipliers = [Vector::x(), -Vector::y(), Vector::new(3.0, 1.0, -9.0), Vector::zeros()];
    let mut y = y_free.clone();
    let mut state = LcpState { y: &mut y, limit_multipliers: &mut limit_multipliers, ..LcpState::default() };
    apply_multipliers(&problem, &mut state).unwrap();
    assert!((state.y[1] - (y_free[1] + Vector::x() + Vector::y())).norm() < 1e-15, "signs: +f_0, -f_1");
    solve_serial(&problem, &mut state, &TIGHT).unwrap();
    for (a, b) in y.iter().zip(&expected) {
        assert!((a - b).norm() < 1e-10, "{a:?} {b:?}");
    }
}

#[test]
fn an_upper_bound_caps_the_force() {
    // A soft ground: holding the node takes 3, and the bound is 2.
    let weights = [1.0];
    let mut rows = [Row::new([0; 4], [Vector::z(), Vector::zeros(), Vector::zeros(), Vector::zeros()], 0.0)];
    rows[0].upper = 2.0;
    prepare_rows(&mut rows, &weights).unwrap();
    let problem = LcpProblem::of_rows(&weights, &rows).unwrap();
    for exact in [false, true] {
        let (mut y, mut lambda) = ([Vector::z() * -3.0], [0.0]);
        let mut state = LcpState { y: &mut y, lambda: &mut lambda, ..LcpState::default() };
        let solve = if exact {
            solve_exact(&problem, &mut state)
        } else {
            solve_serial(&problem, &mut state, &TIGHT)
        };
        assert_eq!(solve.unwrap().residual, 0.0);
        assert_eq!((y[0].z, lambda[0]), (-1.0, 2.0));
    }
}

/// A node on the plane z = 0 with friction, pressed to depth 2 and dragged by `drag`.
fn dragged(weight: f64, drag: Vector2<f64>, bound: FrictionBound) -> (Vector, f64, Vector2<f64>) {
    let weights = [weight];
    let zero = Vector::zeros();
    let mut rows = [Row::new([0; 4], [Vector::z(), zero, zero, zero], 0.0)];
    prepare_rows(&mut rows, &weights).unwrap();
    let mut friction = [FrictionRow {
        tangents: [Vector::x(), Vector::y()],
        coefficients: [1.0, 0.0, 0.0, 0.0],
        offsets: [-5.0, 0.0],
        vertices: [0; 4],
        friction: 0.5,
        inverse_diagonal: f64::NAN,
        normal: 0,
    }];
    prepare_friction(&mut friction, &weights).unwrap();
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::serial(&rows),
        ConstraintSet::default(),
        ConstraintSet::serial(&friction),
    )
    .unwrap();
    // The step started at x = 5.
    let (mut y, mut lambda, mut multipliers) =
        ([Vector::new(5.0 + drag.x, drag.y, -2.0)], [0.0], [Vector2::zeros()]);
    let mut state =
        LcpState { y: &mut y, lambda: &mut lambda, limit_multipliers: &mut [], friction: &mut multipliers };
    let params = LcpParams { friction_bound: bound, ..TIGHT };
    solve_serial(&problem, &mut state, &params).unwrap();
    let judged = residuals(&problem, &state, bound).unwrap();
    assert!(judged.complementarity < 1e-13 && judged.friction_correction < 1e-13, "{judged:?}");
    (y[0], lambda[0], multipliers[0])
}

#[test]
fn a_block_sticks_inside_the_cone_and_slides_by_the_excess_outside() {
    for weight in [1.0, 0.25] {
        // Friction can undo a drag of mu x depth = 1, for any weight.
        let (y, lambda, multipliers) = dragged(weight, Vector2::new(0.6, 0.7), FrictionBound::Disc);
        assert_near(y, Vector::new(5.0, 0.0, 0.0));
        assert!((lambda - 2.0 / weight).abs() < 1e-12);
        assert!((multipliers + Vector2::new(0.6, 0.7) / weight).norm() < 1e-12);
        let (y, lambda, multipliers) = dragged(weight, Vector2::new(3.0, 4.0), FrictionBound::Disc);
        assert_near(y, Vector::new(5.0 + 0.6 * 4.0, 0.8 * 4.0, 0.0));
        assert!((multipliers.norm() - 0.5 * lambda).abs() < 1e-12);
        // The square lets each tangent use the whole bound.
        let (y, ..) = dragged(weight, Vector2::new(3.0, 4.0), FrictionBound::Square);
        assert_near(y, Vector::new(5.0 + 2.0, 3.0, 0.0));
    }
}

#[test]
fn a_block_on_an_incline_slides_beyond_the_angle_of_friction() {
    // Fall by g along -z onto a plane tilted by `angle`: it slides by g (sin - mu cos), if that is positive.
    let (mu, g) = (0.5_f64, 0.1);
    for angle in [0.2_f64, 0.4, mu.atan() - 1e-3, mu.atan() + 1e-3, 0.7, 1.2] {
        let (sin, cos) = angle.sin_cos();
        let (normal, down) = (Vector::new(sin, 0.0, cos), Vector::new(cos, 0.0, -sin));
        let weights = [0.7];
        let zero = Vector::zeros();
        let mut rows = [Row::new([0; 4], [normal, zero, zero, zero], 0.0)];
        prepare_rows(&mut rows, &weights).unwrap();
        let mut friction = [FrictionRow {
            tangents: [Vector::y(), down],
            coefficients: [1.0, 0.0, 0.0, 0.0],
            offsets: [0.0; 2],
            vertices: [0; 4],
            friction: mu,
            inverse_diagonal: f64::NAN,
            normal: 0,
        }];
        prepare_friction(&mut friction, &weights).unwrap();
        let problem = LcpProblem::new(
            &weights,
            ConstraintSet::serial(&rows),
            ConstraintSet::default(),
            ConstraintSet::serial(&friction),
        )
        .unwrap();
        let (mut y, mut lambda, mut multipliers) = ([Vector::z() * -g], [0.0], [Vector2::zeros()]);
        let mut state = LcpState {
            y: &mut y,
            lambda: &mut lambda,
            limit_multipliers: &mut [],
            friction: &mut multipliers,
        };
        solve_serial(&problem, &mut state, &TIGHT).unwrap();
        assert_near(y[0], down * (g * (sin - mu * cos)).max(0.0));
    }
}

#[test]
fn a_node_in_two_places_of_a_row_counts_with_its_summed_gradient() {
    let weights = [1.0, 0.5];
    let (g, zero) = (Vector::new(0.3, -0.2, 0.9), Vector::zeros());
    let mut split = [Row::new([0, 1, 0, 0], [g * 0.75, -g, g * 1.5, g * -0.25], -1.0)];
    let mut merged = [Row::new([0, 1, 0, 0], [g * 2.0, -g, zero, zero], -1.0)];
    let mut results = Vec::new();
    for rows in [&mut split, &mut merged] {
        prepare_rows(rows, &weights).unwrap();
        let problem = LcpProblem::of_rows(&weights, rows).unwrap();
        let (mut y, mut lambda) = ([Vector::zeros(); 2], [0.0]);
        let mut state = LcpState { y: &mut y, lambda: &mut lambda, ..LcpState::default() };
        // One sweep solves one row exactly.
        sweep_serial(&problem, &mut state, &TIGHT).unwrap();
        assert!(rows[0].value(&y).abs() < 1e-15);
        results.push((y[0], y[1], lambda[0]));
    }
    assert_near(results[0].0, results[1].0);
    assert_near(results[0].1, results[1].1);
    assert!((results[0].2 - results[1].2).abs() < 1e-14);
}

/// Solves by `solve`, with the state of a node dragged over two others that form an edge, all free.
fn rub(
    friction: FrictionRow,
    solve: impl Fn(&LcpProblem<'_>, &mut LcpState<'_>),
) -> ([Vector; 3], Vector2<f64>) {
    let weights = [1.0, 0.5, 2.0];
    let z = Vector::z();
    let mut rows = [Row::new([0, 1, 2, 0], [z, z * -0.5, z * -0.5, Vector::zeros()], -0.1)];
    prepare_rows(&mut rows, &weights).unwrap();
    let mut friction = [friction];
    prepare_friction(&mut friction, &weights).unwrap();
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::serial(&rows),
        ConstraintSet::default(),
        ConstraintSet::serial(&friction),
    )
    .unwrap();
    let mut y = [Vector::new(0.3, 0.1, -1.0), Vector::zeros(), Vector::zeros()];
    let (mut lambda, mut multipliers) = ([0.0], [Vector2::zeros()]);
    let mut state =
        LcpState { y: &mut y, lambda: &mut lambda, limit_multipliers: &mut [], friction: &mut multipliers };
    solve(&problem, &mut state);
    let judged = residuals(&problem, &state, FrictionBound::Disc).unwrap();
    assert!(judged.complementarity < 1e-12 && judged.friction_correction < 1e-12, "{judged:?}");
    // The free positions and the multipliers alone give the same state.
    let mut again = [Vector::new(0.3, 0.1, -1.0), Vector::zeros(), Vector::zeros()];
    let mut replay = LcpState {
        y: &mut again,
        lambda: state.lambda,
        limit_multipliers: &mut [],
        friction: state.friction,
    };
    apply_multipliers(&problem, &mut replay).unwrap();
    again.iter().zip(&y).for_each(|(a, b)| assert_near(*a, *b));
    (y, multipliers[0])
}

#[test]
fn friction_between_free_nodes_agrees_over_solvers_and_spellings_and_keeps_momentum() {
    let friction = FrictionRow {
        tangents: [Vector::x(), Vector::y()],
        coefficients: [1.0, -0.5, -0.5, 0.0],
        offsets: [0.0; 2],
        vertices: [0, 1, 2, 0],
        friction: 0.1,
        inverse_diagonal: f64::NAN,
        normal: 0,
    };
    let serial = |problem: &LcpProblem<'_>, state: &mut LcpState<'_>| {
        solve_serial(problem, state, &TIGHT).unwrap();
    };
    let (y, multiplier) = rub(friction, serial);
    // 1 + (0.5 + 2) / 4 = 1.625 is the diagonal of both: lambda = 1.1 / 1.625, slip 0.316 - 0.11 along the
    // drag.
    let (lambda, drag) = (1.1 / 1.625, Vector2::new(0.3, 0.1));
    assert!((multiplier + drag.normalize() * (0.1 * lambda)).norm() < 1e-12, "{multiplier:?}");
    let slip = (y[0] - 0.5 * (y[1] + y[2])).xy();
    assert!((slip - drag * (1.0 - 0.11 / drag.norm())).norm() < 1e-12, "{slip:?}");
    let momentum = y[0] + y[1] / 0.5 + y[2] / 2.0;
    assert_near(momentum, Vector::new(0.3, 0.1, -1.0));

    // Node 2 in two places: the same diagonal.
    let mut split = FrictionRow { coefficients: [1.0, -0.5, -0.7, 0.2], vertices: [0, 1, 2, 2], ..friction };
    split.prepare(&[1.0, 0.5, 2.0]).unwrap();
    assert!((split.inverse_diagonal - 1.0 / 1.625).abs() < 1e-15);
    let (again, _) = rub(split, serial);
    again.iter().zip(&y).for_each(|(a, b)| assert_near(*a, *b));
    let (again, _) = rub(split, |problem, state| {
        let params = LcpParams { relaxation: 1.5, max_sweeps: 100_000, ..TIGHT };
        Jacobi::new().solve(problem, state, &params).unwrap();
    });
    again.iter().zip(&y).for_each(|(a, b)| assert!((a - b).norm() < 1e-10));
}

#[test]
fn relaxation_scales_the_first_step_of_every_kind_of_row() {
    let weights = [1.0, 1.0];
    let zero = Vector::zeros();
    let mut rows = [Row::new([0; 4], [Vector::z(), zero, zero, zero], 0.0)];
    prepare_rows(&mut rows, &weights).unwrap();
    let limits = [limit(0, 1, 1.0)];
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::serial(&rows),
        ConstraintSet::serial(&limits),
        ConstraintSet::default(),
    )
    .unwrap();
    for relaxation in [0.5, 1.0, 1.5] {
        let (mut y, mut lambda, mut limit_multipliers) =
            ([Vector::new(3.0, 0.0, -2.0), Vector::z() * -2.0], [0.0], [zero]);
        let mut state = LcpState {
            y: &mut y,
            lambda: &mut lambda,
            limit_multipliers: &mut limit_multipliers,
            friction: &mut [],
        };
        sweep_serial(&problem, &mut state, &LcpParams { relaxation, ..TIGHT }).unwrap();
        assert_near(limit_multipliers[0], Vector::x() * relaxation);
        assert!((lambda[0] - 2.0 * relaxation).abs() < 1e-15);
    }
}

#[test]
fn equations_pull_where_complementarity_lets_go() {
    // Two nodes of weight 1 at the ground x >= 0: one is below it, the other moves away from it. A third row
    // ties them.
    let zero = Vector::zeros();
    let x = Vector::x();
    let mut rows = vec![
        Row::new([0; 4], [x, zero, zero, zero], 0.0),
        Row::new([1; 4], [x, zero, zero, zero], 0.0),
        Row::new([0, 1, 0, 0], [x * 0.5, x * -0.5, zero, zero], 0.25),
    ];
    rows[2].upper = 0.125;
    let weights = vec![1.0; 2];
    prepare_rows(&mut rows, &weights).unwrap();
    let problem = LcpProblem::of_rows(&weights, &rows[..2]).unwrap();
    type Solve = fn(&LcpProblem<'_>, &mut LcpState<'_>, &LcpParams) -> Result<LcpInfo, LcpError>;
    let jacobi: Solve = |problem, state, params| Jacobi::new().solve(problem, state, params);
    for solve in [solve_serial as Solve, solve_colored, jacobi] {
        for (equations, expected) in [(false, [3.0, 0.0]), (true, [3.0, -2.0])] {
            let params = LcpParams { equations, ..TIGHT };
            let (mut y, mut lambda) = (vec![x * -3.0, x * 2.0], vec![0.0; 2]);
            solve(&problem, &mut LcpState { y: &mut y, lambda: &mut lambda, ..LcpState::default() }, &params)
                .unwrap();
            assert_eq!(lambda, expected);
        }
    }
    // The third row makes the system redundant, and it contradicts the first two: for x0 = x1 = 0 its value
    // is 1/4. Its multiplier has no bound and grows from sweep to sweep, but is never NaN.
    let problem = LcpProblem::of_rows(&weights, &rows).unwrap();
    let (mut y, mut lambda) = (vec![x * -3.0, x * 2.0], vec![0.0; 3]);
    let params = LcpParams { equations: true, max_sweeps: 1000, ..LcpParams::default() };
    solve_serial(&problem, &mut LcpState { y: &mut y, lambda: &mut lambda, ..LcpState::default() }, &params)
        .unwrap();
    assert!(lambda[2] < -100.0 && lambda.iter().all(|l| l.is_finite()), "{lambda:?}");
}
