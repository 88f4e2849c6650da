//! Sums over components.

use super::UNIT;
use super::fixture::{DT, LIMITS, fixtures, read, solver};
use crate::engine::TwinEngine;
use bowknot_dynamics::{AssemblySprings, NewtonBackend, SolveLimits};
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;

/// What is summed over components is b - R p, without what sums to zero; translations take it away.
#[test]
fn components_get_their_momentum() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        solver.linearize(false).expect("runs");
        solver.solve(&fixture.springs(), &SolveLimits { tolerance: 0.1, ..LIMITS }).expect("runs");
        let vectors = solver.newton.as_ref().expect("one").vectors;
        let gradient = fixture.gradient(&x);
        let step = fixture.terms.as_step();
        let components = &fixture.model.components;
        let nodes = |c: usize| components[c].start as usize..components[c].end as usize;
        for round in 0..2 {
            let p = read(&mut solver, vectors.step);
            let mut sums = Vec::new();
            solver.component_residuals(&mut sums).expect("runs");
            assert_eq!(sums.len(), components.len());
            let mut again = Vec::new();
            solver.component_residuals(&mut again).expect("runs");
            assert_eq!(sums, again);
            let mut ways = Vec::new();
            for (c, sum) in sums.iter().enumerate() {
                let expected: Vector = nodes(c).map(|n| -gradient[n] - step.row_sums[n] * p[n]).sum();
                // The pairs of bending and elements are exact in double precision; here inertia alone is
                // rounded.
                let moved = |n: usize| x[n] - step.start[n] + p[n];
                let scale: f64 = nodes(c).map(|n| (step.row_sums[n] * moved(n)).norm()).sum();
                let error = (sum - expected).norm() / scale;
                assert!(error < 16.0 * UNIT, "{}: {error:e}", fixture.name);
                if round == 1 && nodes(c).all(|n| fixture.free[n]) {
                    assert!(sum.norm() < 16.0 * UNIT * scale, "{}: {:e}", fixture.name, sum.norm() / scale);
                }
                let total: Matrix3<f64> = nodes(c).map(|n| step.row_sums[n]).sum();
                ways.push(total.try_inverse().expect("a mass") * sum);
            }
            solver.translate(&ways).expect("runs");
            let after = read(&mut solver, vectors.step);
            for c in 0..components.len() {
                for n in nodes(c) {
                    let way = if fixture.free[n] { ways[c] } else { Vector::zeros() };
                    assert!((after[n] - p[n] - way).norm() <= 4.0 * UNIT * (p[n].norm() + way.norm()));
                }
            }
        }
    }
}

#[test]
fn forces_out_of_balance_are_those_of_the_cpu() {
    for mut fixture in fixtures() {
        fixture.springs.clear();
        fixture.model.patches.clear();
        let rest: Vec<Point> = fixture.dynamics.model().rest_positions().to_vec();
        let node = |vertex: &Point| fixture.model.rest.iter().position(|x| *x == vertex.coords).expect("one");
        let nodes: Vec<usize> = rest.iter().map(node).collect();
        let counted: Vec<bool> = (0..fixture.free.len()).map(|n| n % 5 != 2).collect();
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        let by_vertex = |values: &[bool]| nodes.iter().map(|n| values[*n]).collect::<Vec<bool>>();
        let points: Vec<Point> = nodes.iter().map(|n| Point::from(x[*n])).collect();
        let held: Vec<bool> = by_vertex(&fixture.free).iter().map(|free| !free).collect();
        let expected = fixture.dynamics.residual(&points, &held, &by_vertex(&counted)).expect("a step");
        let none = vec![Vector::zeros(); x.len()];
        let no_springs = AssemblySprings::default();
        let found = solver.out_of_balance(&no_springs, &none, &counted, false).expect("runs");
        let (mut largest, mut worst) = (0.0f64, 0.0f64);
        for (component, product) in fixture.model.components.iter().zip(&found.products) {
            let free = component.clone().filter(|n| fixture.free[*n as usize]);
            let mass: f64 = free.map(|n| fixture.masses[n as usize]).sum();
            assert!(*product >= 0.0);
            largest = largest.max(if mass > 0.0 { product / mass } else { 0.0 });
            worst = worst.max(*product);
        }
        let force = found.squared_force.sqrt();
        println!("{}: {force:e} and {:e} N", fixture.name, expected.force);
        assert!((force - expected.force).abs() < 1e-4 * expected.force, "{}", fixture.name);
        let distance = DT * largest.sqrt();
        println!("{}: {distance:e} and {:e} m", fixture.name, expected.distance);
        assert!((distance - expected.distance).abs() < 1e-3 * expected.distance, "{}", fixture.name);

        // Known forces that are all there are leave nothing, and do not change the gradient.
        let gradient = fixture.gradient(&x);
        let balanced = solver.out_of_balance(&no_springs, &gradient, &counted, false).expect("runs");
        assert!(balanced.squared_force.sqrt() < 1e-4 * force, "{}: {balanced:?}", fixture.name);
        let again = solver.out_of_balance(&no_springs, &none, &counted, false).expect("runs");
        assert!(worst > 0.0 && again == found);
    }
}

#[test]
fn springs_stiffen_what_forces_out_of_balance_are_measured_with() {
    for fixture in fixtures() {
        let mut solver = solver(TwinEngine::new(), &fixture);
        let x = fixture.begin(&mut solver);
        let (none, counted) = (vec![Vector::zeros(); x.len()], vec![true; x.len()]);
        let mut products = |springs: &AssemblySprings<'_>| {
            let balance = solver.out_of_balance(springs, &none, &counted, false).expect("runs");
            (balance.products.iter().sum::<f64>(), balance.squared_force)
        };
        let (without, force) = products(&AssemblySprings::default());
        let (with, same) = products(&fixture.springs());
        assert_eq!(force, same);
        let is_stiffer = if fixture.springs.is_empty() { with == without } else { with < 0.999 * without };
        assert!(is_stiffer, "{}: {with} {without}", fixture.name);
    }
}
