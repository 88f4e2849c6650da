//! Trials, iterates and grids.

use super::fixture::{LIMITS, fixtures, flat, read, solver};
use super::{UNIT, largest};
use crate::engine::TwinEngine;
use bowknot_dynamics::NewtonBackend;
use bowknot_geometry::Vector;

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
            // One submission makes the reference and the full step with the same bits.
            if length == 1.0 {
                assert_eq!(solver.begin_search().expect("runs"), (reference.watched.clone(), trial.clone()));
            }
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
    assert_eq!(fixture.begin_target(&mut solver, &fixture.iterate), x);
    let back = solver.place(0.0).expect("runs");
    for n in 0..x.len() {
        assert!((back.watched[n] - x[n] - fixture.imposed[n]).amax() < 1e-8);
    }
    solver.linearize(false).expect("runs");
    let returned = read(&mut solver, gradient);
    assert!(returned != moved);
}

/// An iterate far from where the step began: the grid becomes coarser, and all that lies on it stays where it
/// is.
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
            read(&mut solver, buffer);
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
        let (at_reference, trial) = solver.begin_search().expect("runs");
        assert_eq!(at_reference, reference.watched);
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

/// Newton iterations end where the gradient in double precision vanishes, but for what single precision
/// leaves of large forces that cancel.
#[test]
fn newtons_method_ends_at_the_minimum_of_double_precision() {
    for mut fixture in fixtures() {
        fixture.springs.clear();
        let mut solver = solver(TwinEngine::new(), &fixture);
        let mut x = fixture.begin(&mut solver);
        let force = |x: &[Vector]| {
            let gradient = fixture.dynamics.bodies_potential(x).expect("a step").gradient;
            gradient
                .iter()
                .zip(&fixture.free)
                .filter(|(_, free)| **free)
                .map(|(g, _)| g.norm())
                .fold(0.0, f64::max)
        };
        let first = force(&x);
        for iteration in 0..20 {
            solver.linearize(false).expect("runs");
            solver.solve(&fixture.springs(), &LIMITS).expect("runs");
            solver.place(0.0).expect("runs");
            let mut length = 1.0;
            let mut trial = solver.place(length).expect("runs");
            while trial.change > trial.rounding && length > 1e-3 {
                length *= 0.5;
                trial = solver.place(length).expect("runs");
            }
            solver.start_from_trial().expect("runs");
            x = trial.watched;
            let left = force(&x) / (UNIT * fixture.force_scale(&x));
            println!(
                "{} {iteration}: {:.1e} of the first force, {left:.1} units",
                fixture.name,
                force(&x) / first
            );
            if left < 40.0 {
                break;
            }
        }
        let left = force(&x);
        assert!(left < 40.0 * UNIT * fixture.force_scale(&x), "{}: {left:e} N of {first:e} N", fixture.name);
        assert!(left < 1e-3 * first, "{}: {left:e} N of {first:e} N", fixture.name);
    }
}
