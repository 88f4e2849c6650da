//! Right-hand sides, starts and solutions beside dense algebra.

use super::fixture::{LIMITS, dense_solve, fixtures, flat, masked, matrix, read, solver};
use super::{UNIT, largest};
use crate::engine::TwinEngine;
use bowknot_dynamics::{AssemblySprings, NewtonBackend, NewtonStep, SolveLimits};
use bowknot_geometry::Vector;
use nalgebra::{DMatrix, DVector, Matrix3};

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
            // In the norm of H: the residual is as small in that of the preconditioner, which approximates
            // the inverse.
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

/// Rounds correct each other until single precision gains too little; limits of iterations are kept on the
/// way.
#[test]
fn rounds_follow_until_they_gain_too_little() {
    let fixture = &fixtures()[0];
    let mut solver = solver(TwinEngine::new(), fixture);
    fixture.begin(&mut solver);
    solver.linearize(false).expect("runs");
    let mut solve = |tolerance: f64, max_iterations: usize| {
        let limits = SolveLimits { tolerance, max_iterations, ..LIMITS };
        solver.solve(&fixture.springs(), &limits).expect("runs")
    };
    let loose = solve(1e-3, 2000);
    let tight = solve(3e-6, 2000);
    assert!(loose.info.converged && tight.info.converged && loose.info.residual <= 1e-3);
    assert!(tight.info.iterations > loose.info.iterations && tight.info.residual <= 3e-6, "{tight:?}");
    let impossible = solve(1e-12, 2000);
    assert!(impossible.stalled && !impossible.info.converged, "{impossible:?}");
    assert!(impossible.info.residual < 3e-6 && impossible.info.iterations < 1000, "{impossible:?}");
    for limit in [1, 16, 17, 40] {
        let ended = solve(1e-5, limit);
        assert!(ended.info.iterations == limit && !ended.info.converged, "{ended:?}");
    }
    // What may end relative to something larger ends at once, and what is small enough needs no iteration.
    let limits = SolveLimits { min_scale: 1e12 * loose.scale, ..LIMITS };
    let corrected = solver.solve(&fixture.springs(), &limits).expect("runs");
    assert!(corrected.info.converged && corrected.info.iterations == 0, "{corrected:?}");
    let limits = SolveLimits { tolerance: 1e-9, own_tolerance: 0.03, ..LIMITS };
    let inexact = solver.solve(&fixture.springs(), &limits).expect("runs");
    assert!(inexact.info.converged && inexact.info.residual <= 0.03, "{inexact:?}");
    assert!(inexact.info.iterations < loose.info.iterations, "{inexact:?}");
}
