use super::systems::{Solution, System};
use bowknot_baselines::rows::AugmentedLagrangian;
use bowknot_baselines::twoway::geometry::Vector;
use bowknot_baselines::twoway::lcp::{
    ConstraintSet, DistanceLimit, LcpProblem, LcpState, Row, prepare_rows, solve_exact,
};

fn descend(system: &System, mut solver: AugmentedLagrangian) -> Solution {
    system.solve(|problem, state| solver.descend(problem, &system.free, state))
}

#[test]
fn it_comes_to_the_corner_of_two_constraints() {
    // y - y' = (3, 1) = 2 (1, 0) + sqrt 2 (1, 1)/sqrt 2: both hold, with these multipliers.
    let system = System::corner([-3.0, -1.0]);
    let expected = Solution { y: vec![Vector::zeros()], lambda: vec![2.0, 2f64.sqrt()] };
    for (penalty, gradient_steps) in [(0.3, 1), (1.0, 1), (1.0, 5), (10.0, 1)] {
        let mut solver = AugmentedLagrangian::by_vertices(4000);
        (solver.penalty, solver.gradient_steps) = (penalty, gradient_steps);
        descend(&system, solver).assert_near(&expected, 1e-9);
    }
    // And where only the second holds.
    let expected = Solution { y: vec![Vector::new(2.0, -2.0, 0.0)], lambda: vec![0.0, 2f64.sqrt()] };
    descend(&System::corner([1.0, -3.0]), AugmentedLagrangian::by_vertices(4000))
        .assert_near(&expected, 1e-9);
    // As published: steps are taken as they are once L, which grows with lambda^2/(2 rho), changes by less than
    // 1e-10.
    let off = (2.0 * 1000.0 * 1e-10f64).sqrt();
    descend(&System::corner([1.0, -3.0]), AugmentedLagrangian::new(4000)).assert_near(&expected, off);
}

#[test]
fn more_iterations_come_nearer_but_twenty_are_far() {
    let system = System::column(20);
    let violation = |iterations: usize| {
        let y = descend(&system, AugmentedLagrangian::by_vertices(iterations)).y;
        system.rows.iter().map(|row| -row.value(&y)).fold(0.0, f64::max)
    };
    let violations = [20, 100, 4000].map(violation);
    assert!(violations[0] > violations[1] && violations[1] > violations[2], "{violations:?}");
    assert!(violations[2] < 1e-6, "{violations:?}");
}

#[test]
fn it_comes_to_the_reference_on_random_systems() {
    for seed in 0..30 {
        let system = System::random(seed);
        let exact = system.solve(|problem, state| {
            solve_exact(problem, state).unwrap();
        });
        descend(&system, AugmentedLagrangian::by_vertices(100_000)).assert_near(&exact, 1e-6);
    }
}

#[test]
fn a_stretched_edge_shrinks_to_its_limit_and_pinned_nodes_stay() {
    let weights = [0.0, 2.0];
    let free = [Vector::new(1.0, 0.0, 0.0), Vector::new(1.0, 3.0, 4.0)];
    let balls = [DistanceLimit { vertices: [0, 1], limit: 1.0 }];
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::default(),
        ConstraintSet::serial(&balls),
        ConstraintSet::default(),
    )
    .unwrap();
    let (mut y, mut forces) = (free, [Vector::zeros()]);
    let mut state = LcpState { y: &mut y, limit_multipliers: &mut forces, ..LcpState::default() };
    AugmentedLagrangian::by_vertices(2000).descend(&problem, &free, &mut state);
    assert_eq!(y[0], free[0]);
    assert!((y[1] - Vector::new(1.0, 0.6, 0.8)).norm() < 1e-9, "{:?}", y[1]);
    // m (y' - y) = -f with f from b to a: (5 - 1)/w.
    assert!((forces[0] - Vector::new(0.0, -0.6, -0.8) * 2.0).norm() < 1e-9, "{:?}", forces[0]);
}

#[test]
fn as_published_each_zone_has_a_step_length_of_its_own_and_the_function_falls() {
    // A stiff column, and one vertex apart that alone would take few steps.
    let column = System::column(20);
    let lowest = |iterations: usize| {
        let y = descend(&column, AugmentedLagrangian::new(iterations)).y;
        column.rows.iter().map(|row| -row.value(&y)).fold(0.0, f64::max)
    };
    let violations = [5, 100, 2000].map(lowest);
    assert!(violations[0] > 1e-3 && violations[1] < 1e-6 && violations[2] < 1e-6, "{violations:?}");
    let weights = [1.0; 3];
    let free = [Vector::new(-1.0, 0.0, 0.0), Vector::new(-1.0, 0.0, 0.0), Vector::new(0.0, 5.0, 0.0)];
    let gradients = |scale: f64| [scale * Vector::x(), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    // The second row is a thousand times stiffer.
    let mut rows = [Row::new([0; 4], gradients(0.03), 0.0), Row::new([1; 4], gradients(1.0), 0.0)];
    prepare_rows(&mut rows, &weights).unwrap();
    let problem = LcpProblem::new(
        &weights,
        ConstraintSet::serial(&rows),
        ConstraintSet::default(),
        ConstraintSet::default(),
    )
    .unwrap();
    let (mut y, mut lambda) = ([Vector::zeros(); 3], [7.0, 7.0]);
    let mut state = LcpState { y: &mut y, lambda: &mut lambda, ..LcpState::default() };
    let mut solver = AugmentedLagrangian::new(3000);
    solver.penalty = 100.0;
    solver.descend(&problem, &free, &mut state);
    assert!(y[0].norm() < 1e-4 && y[1].norm() < 1e-4, "{y:?}");
    // What no row holds is at its target.
    assert_eq!(y[2], free[2]);
    // m (y - y') = J^T lambda.
    assert!((lambda[0] - 1.0 / 0.03).abs() < 0.01 && (lambda[1] - 1.0).abs() < 1e-3, "{lambda:?}");
}
