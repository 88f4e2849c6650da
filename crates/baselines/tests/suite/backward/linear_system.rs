use super::systems::System;
use bowknot_baselines::rows::LinearSystem;
use bowknot_baselines::twoway::geometry::Vector;
use bowknot_baselines::twoway::lcp::{LcpParams, solve_exact, solve_serial};

#[test]
fn without_projection_it_pulls_where_the_complementarity_problem_lets_go() {
    // The node wants to leave the line x = 0 and to cross the line x + y = 0.
    let system = System::corner([1.0, -3.0]);
    let exact = system.solve(|problem, state| {
        solve_exact(problem, state).unwrap();
    });
    // Onto x + y = 0 alone.
    assert!((exact.y[0] - Vector::new(2.0, -2.0, 0.0)).norm() < 1e-12);
    assert!(exact.lambda[0] == 0.0 && (exact.lambda[1] - 2f64.sqrt()).abs() < 1e-12);

    let patient = LinearSystem { sweeps: 200, projected: false };
    let pulled = system.solve(|problem, state| patient.sweep(problem, state).unwrap());
    // Both hold: the corner. y - y' = (-1, 3) = lambda_0 (1, 0) + lambda_1 (1, 1)/sqrt 2.
    assert!(pulled.y[0].norm() < 1e-12);
    assert!((pulled.lambda[0] + 4.0).abs() < 1e-12 && (pulled.lambda[1] - 3.0 * 2f64.sqrt()).abs() < 1e-12);

    let projected = LinearSystem { sweeps: 200, projected: true };
    system.solve(|problem, state| projected.sweep(problem, state).unwrap()).assert_near(&exact, 1e-12);
}

#[test]
fn with_the_projection_it_is_projected_gauss_seidel_to_the_bit() {
    for seed in 0..50 {
        let system = System::random(seed);
        let yardstick = system.solve(|problem, state| {
            solve_serial(problem, state, &LcpParams { max_sweeps: 20, ..LcpParams::default() }).unwrap();
        });
        let harmon = system.solve(|problem, state| LinearSystem::projected().sweep(problem, state).unwrap());
        assert_eq!(harmon, yardstick);
    }
}

#[test]
fn what_it_solves_is_the_linear_system() {
    for seed in 0..50 {
        let system = System::random(seed);
        let patient = LinearSystem { sweeps: 100_000, projected: false };
        let solution = system.solve(|problem, state| patient.sweep(problem, state).unwrap());
        let worst = system.rows.iter().map(|row| row.value(&solution.y).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst:e}");
    }
}
