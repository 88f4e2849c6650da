//! The log barrier by Newton's method.

use crate::common::{Scene, assert_same_on_any_number_of_threads, resolve_watched};
use bowknot_baselines::barrier::{
    BarrierParams, LinearSolver, Objective, barrier, by_descent, by_newton, squared_barrier,
};
use bowknot_baselines::ccd::AdditiveCcd;
use bowknot_baselines::twoway::geometry::{Point, Vector};
use bowknot_baselines::twoway::{AcceptedState, Params, ResolveInput};
use std::ops::ControlFlow;

/// Presses two sheets together.
fn pressed(scene: &Scene, by: f64) -> Vec<Point> {
    let n = scene.x.len() / 2;
    (0..2 * n).map(|v| scene.x[v] + if v < n { by } else { -by } * Vector::z()).collect()
}

#[test]
fn a_vertex_pushed_against_a_triangle_ends_where_the_barrier_balances_its_inertia() {
    let scene = Scene::vertex_above_triangle(0.05);
    let mut target = scene.x.clone();
    target[3].z = -0.03;
    for mut params in [Params::fast(), Params::paper()] {
        params.contact.delta = Some(0.01);
        let settings = BarrierParams { strength: 200.0, tolerance: 1e-9, ..BarrierParams::default() };
        let mut resolver =
            by_newton(scene.collision_scene(params), settings, AdditiveCcd::default()).unwrap();
        let (x, report) = resolve_watched(&mut resolver, &scene, &target, "newton");
        assert!(report.converged && report.steps < 40, "{report:?}");
        let min_separation = resolver.state().contacts.min_separations[0];
        let force = 0.01 / 1e-4 * (x[3].z + 0.03);
        let push = barrier(200.0, x[3].z - min_separation, 0.01 - min_separation).slope;
        assert!((force + push).abs() < 1e-6 * force, "{force} N, {push} N at {} m", x[3].z);
        assert!((x[3].xy() - scene.x[3].xy()).norm() < 1e-12);
    }
}

#[test]
fn ipc_starts_with_its_least_stiffness_where_nothing_touches() {
    let scene = Scene::vertex_above_triangle(0.05);
    let mut target = scene.x.clone();
    target[3].z = -0.03;
    let mut params = Params::paper();
    params.contact.delta = Some(0.01);
    let settings = BarrierParams { tolerance: 1e-9, ..BarrierParams::ipc() };
    let mut resolver = by_newton(scene.collision_scene(params), settings, AdditiveCcd::default()).unwrap();
    let (x, report) = resolve_watched(&mut resolver, &scene, &target, "ipc");
    assert!(report.converged && report.steps < 40, "{report:?}");
    // 1e11 m/h^2 = 4 kappa d0 b''(d0) at the square d0 of 1e-8 of the diagonal.
    let diagonal = Vector::new(3.0, 3.0, 0.05).norm();
    let (square, range, inertia) = ((1e-8 * diagonal).powi(2), 0.01 * 0.01, 0.01 / 1e-4);
    let stiffness = 1e11 * inertia / (4.0 * square * barrier(1.0, square, range).curvature);
    let force = inertia * (x[3].z + 0.03);
    let push = squared_barrier(stiffness, x[3].z, 0.01, 0.0).slope;
    assert!((force + push).abs() < 1e-6 * force, "{force} N, {push} N at {} m", x[3].z);
}

#[test]
fn both_linear_solvers_and_both_barriers_keep_sheets_apart() {
    // The sheets lie one above the other, so that all their edges are parallel.
    let scene = Scene::two_sheets(4, 0.008);
    let target = pressed(&scene, 0.006);
    for params in [BarrierParams::default(), BarrierParams::ipc()] {
        let ends = [LinearSolver::Cholesky, LinearSolver::ConjugateGradients].map(|linear_solver| {
            let mut two_way = Params::paper();
            two_way.contact.delta = Some(0.01);
            let settings = BarrierParams { linear_solver, tolerance: 1e-4, ..params.clone() };
            let collision = scene.collision_scene(two_way);
            let mut resolver = by_newton(collision, settings, AdditiveCcd::default()).unwrap();
            let (x, report) = resolve_watched(&mut resolver, &scene, &target, "sheets");
            assert!(report.converged && report.contact_rows > 20, "{report:?}");
            x
        });
        let apart = ends[0].iter().zip(&ends[1]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(apart < 1e-4, "{apart}");
        assert!(ends[0][0].z < ends[0][ends[0].len() / 2].z, "they changed places");
    }
}

#[test]
fn newton_and_gradient_descent_reach_the_same_minimum() {
    let scene = Scene::turned_sheets(3, 0.008);
    let target = pressed(&scene, 0.006);
    // An edge penalty that pulls as well, and no minimum separation, which would depend on where a pair was
    // first seen.
    let mut params = Params::paper();
    params.contact.delta = Some(0.01);
    params.solver.stop.max_steps = Some(20_000);
    let settings = BarrierParams { tolerance: 1e-8, edge_stiffness: 100.0, ..BarrierParams::default() };
    let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
    let mut by_steps = scene.x.clone();
    let mut descent = by_descent(scene.collision_scene(params.clone()), settings.clone()).unwrap();
    let slow = descent.resolve_with(&mut by_steps, &target, &input, &mut ()).unwrap();
    let mut x = scene.x.clone();
    let mut newton = by_newton(scene.collision_scene(params), settings, AdditiveCcd::default()).unwrap();
    let fast = newton.resolve_with(&mut x, &target, &input, &mut ()).unwrap();
    assert!(slow.converged && fast.converged, "{slow:?} {fast:?}");
    assert!(fast.contact_rows > 20, "{fast:?}");
    assert!(fast.steps < 12 && fast.steps < slow.steps, "{} {}", fast.steps, slow.steps);
    let moved = x.iter().zip(&scene.x).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let apart = x.iter().zip(&by_steps).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(moved > 1e-3 && apart < 1e-5 * moved, "{apart} m apart after {moved} m");
    // At the end nothing pulls any more.
    assert!(fast.stationarity_m < 1e-6 * moved, "{fast:?}");
}

#[test]
fn sheets_that_change_places_never_intersect_on_the_way() {
    let scene = Scene::two_sheets(4, 0.04);
    let target = scene.swapped();
    let (eq_8, ipc) = (BarrierParams::default(), BarrierParams::ipc());
    for (name, mut params, settings) in
        [("fast", Params::fast(), &eq_8), ("paper", Params::paper(), &eq_8), ("ipc", Params::paper(), &ipc)]
    {
        params.solver.stop.max_steps = Some(60);
        let collision = scene.collision_scene(params);
        let mut resolver = by_newton(collision, settings.clone(), AdditiveCcd::default()).unwrap();
        let (x, report) = resolve_watched(&mut resolver, &scene, &target, name);
        assert!(report.contact_rows > 10, "{name}: they never met: {report:?}");
        let middle = x.len() / 4;
        assert!(x[middle].z < x[middle + x.len() / 2].z, "{name}: they passed through each other");
    }
}

#[test]
fn an_obstacle_that_comes_pushes_what_is_in_its_way() {
    // The triangle rises through where the particle hovers.
    let scene = Scene::vertex_above_triangle(0.02);
    let mut target = scene.x.clone();
    target[..3].iter_mut().for_each(|p| p.z += 0.1);
    let mut params = Params::fast();
    params.contact.delta = Some(0.01);
    let mut resolver =
        by_newton(scene.collision_scene(params), BarrierParams::default(), AdditiveCcd::default()).unwrap();
    let (x, report) = resolve_watched(&mut resolver, &scene, &target, "obstacle");
    assert!(report.converged, "{report:?}");
    assert!((0..3).all(|v| (x[v] - target[v]).norm() < 1e-3), "{x:?}");
    assert!(x[3].z > 0.1 && x[3].z < 0.111, "{x:?}");
}

#[test]
fn the_energy_falls_step_by_step() {
    let scene = Scene::turned_sheets(4, 0.008);
    let target = pressed(&scene, 0.01);
    let mut params = Params::paper();
    params.contact.delta = Some(0.01);
    let settings = BarrierParams::default();
    let mut energies = Vec::new();
    for steps in 1..12 {
        // Runs of one step more each: what a step does depends on the state alone.
        params.solver.stop.max_steps = Some(steps);
        let collision = scene.collision_scene(params.clone());
        let mut resolver = by_newton(collision, settings.clone(), AdditiveCcd::default()).unwrap();
        let mut x = scene.x.clone();
        let mut taken = 0;
        let mut count = |_: &AcceptedState<'_>| {
            taken += 1;
            ControlFlow::Continue(())
        };
        let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
        resolver.resolve_with(&mut x, &target, &input, &mut count).unwrap();
        let (collision, state) = (resolver.scene(), resolver.state());
        let mut objective = Objective::new(collision, settings.clone()).unwrap();
        objective.begin(collision, state);
        energies.push(objective.value(collision, state, &x, &objective.contacts(collision, state)));
    }
    assert!(energies.windows(2).all(|e| e[1] <= e[0] * (1.0 + 1e-12)), "{energies:?}");
    assert!(energies[10] < 0.96 * energies[0], "{energies:?}");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = Scene::two_sheets(6, 0.008);
    let target = pressed(&scene, 0.01);
    assert_same_on_any_number_of_threads(|| {
        let mut params = Params::fast();
        params.solver.stop.max_steps = Some(15);
        let collision = scene.collision_scene(params);
        let mut resolver = by_newton(collision, BarrierParams::default(), AdditiveCcd::default()).unwrap();
        let mut x = scene.x.clone();
        resolver.resolve(&mut x, &target).unwrap();
        x
    });
}
