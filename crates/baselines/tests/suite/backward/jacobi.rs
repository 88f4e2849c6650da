use super::systems::System;
use bowknot_baselines::rows::ProjectedJacobi;
use bowknot_baselines::twoway::lcp::{LcpParams, solve_exact, solve_serial};

#[test]
fn it_comes_to_the_lambda_of_the_reference_on_random_systems() {
    let mut pressing = 0;
    for seed in 0..200 {
        let system = System::random(seed);
        let exact = system.solve(|problem, state| {
            solve_exact(problem, state).unwrap();
        });
        pressing += exact.lambda.iter().filter(|l| **l > 0.0).count();
        for radius in [0.0, 0.9] {
            let jacobi = system.solve(|problem, state| {
                ProjectedJacobi::new(200_000, radius).sweep(problem, state, Some(1e-13)).unwrap();
            });
            jacobi.assert_near(&exact, 1e-7);
        }
    }
    assert!((400..1000).contains(&pressing), "rows at work and rows at rest: {pressing} of 1400");
}

#[test]
fn chebyshev_weights_save_most_sweeps_on_a_column_of_beads() {
    let system = System::column(20);
    let tolerance = 1e-9;
    let sweeps = |radius: f64| {
        let mut sweeps = 0;
        let solution = system.solve(|problem, state| {
            let mut jacobi = ProjectedJacobi::new(100_000, radius);
            sweeps = jacobi.sweep(problem, state, Some(tolerance)).unwrap().sweeps;
        });
        assert!(system.complementarity(&solution) < 1e-6);
        sweeps
    };
    let mut gauss_seidel = 0;
    system.solve(|problem, state| {
        let params = LcpParams { max_sweeps: 100_000, tolerance: Some(tolerance), ..LcpParams::default() };
        gauss_seidel = solve_serial(problem, state, &params).unwrap().sweeps;
    });
    // A tight column, in which no contact opens or closes: what the weights are made for.
    assert_eq!((sweeps(0.0), sweeps(0.99), gauss_seidel), (10628, 1616, 2772));
}
