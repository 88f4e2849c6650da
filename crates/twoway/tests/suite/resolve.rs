//! Calls of the resolver against closed forms and limits, and the statements of the README.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::sheet;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{AcceptedState, Params, ResolveError, ResolveInput, Resolver, Statistics, StopRule};
use std::ops::ControlFlow;

struct Scene {
    x: Vec<Point>,
    model: CollisionModel,
}

/// Deformable sheets at the given heights, and the ground z = 0 if asked for.
fn sheets(cells: usize, heights: &[f64], ground: bool) -> Scene {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    let mut bodies = Vec::new();
    for (body, &height) in heights.iter().enumerate() {
        sheet(cells, 0.1, height, &mut x, &mut triangles);
        bodies.resize(x.len(), body as u32);
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let half_spaces =
        if ground { vec![HalfSpace::new(Point::origin(), Vector::z()).unwrap()] } else { Vec::new() };
    let filters = vec![BodyFilter::DEFORMABLE; heights.len()];
    Scene { model: CollisionModel::new(topology, bodies, filters, half_spaces).unwrap(), x }
}

fn resolve(scene: &Scene, y: &[Point], params: Params) -> (Vec<Point>, Statistics) {
    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![1.0; scene.x.len()], params).unwrap();
    let mut x = scene.x.clone();
    let report = resolver.resolve(&mut x, y).unwrap();
    (x, report)
}

fn presets() -> [Params; 2] {
    [Params::fast(), Params::paper()]
}

#[test]
fn without_contact_the_target_is_reached_whatever_the_distance() {
    let scene = sheets(4, &[1.0], false);
    for params in presets() {
        let y: Vec<Point> = scene.x.iter().map(|p| p + Vector::new(0.0, 0.5, 0.3)).collect();
        let (x, report) = resolve(&scene, &y, params);
        assert!(report.converged);
        assert_eq!(report.contact_rows, 0);
        let worst = x.iter().zip(&y).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
        assert!(worst < 0.03 * 0.12, "{worst}");
    }
}

#[test]
fn a_sheet_pushed_through_the_ground_rests_on_it_at_delta() {
    let scene = sheets(4, &[0.2], true);
    let y: Vec<Point> = scene.x.iter().map(|p| p - 0.5 * Vector::z()).collect();
    for params in presets() {
        let (x, report) = resolve(&scene, &y, params.clone());
        let lowest = x.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        let delta = 0.1 * mean_edge();
        assert!(lowest > 0.0 && lowest < 1.5 * delta, "{lowest} against {delta}");
        // Only vertical motion is removed.
        for (x, y) in x.iter().zip(&y) {
            assert!((x - y).xy().norm() < 0.02 * mean_edge(), "{x} {y}");
        }
        assert!(report.min_gap_m.unwrap() > 0.0);
    }
}

fn mean_edge() -> f64 {
    0.1 * (40.0 + 16.0 * 2f64.sqrt()) / 56.0
}

#[test]
fn two_sheets_that_want_to_swap_places_do_not() {
    let scene = sheets(4, &[0.0, 0.05], false);
    let n = scene.x.len() / 2;
    let y: Vec<Point> = (0..2 * n).map(|i| scene.x[(i + n) % (2 * n)]).collect();
    for params in presets() {
        let (x, report) = resolve(&scene, &y, params);
        for i in 0..n {
            assert!(x[n + i].z > x[i].z, "vertex {i}: {} under {}", x[n + i], x[i]);
        }
        assert!(report.min_gap_m.unwrap() > 0.0);
    }
}

#[test]
fn a_taut_sheet_moved_along_itself_arrives() {
    // The proximal term slows down rigid motion of taut regions. It must delay that motion, not stop it.
    let scene = sheets(6, &[0.0], false);
    let stretched = |p: &Point, shift: f64| Point::new(1.3 * p.x + shift, p.y, p.z);
    let y: Vec<Point> = scene.x.iter().map(|p| stretched(p, 0.2)).collect();
    let mean = |p: &[Point]| p.iter().map(|p| p.x).sum::<f64>() / p.len() as f64;
    for net_residual in [0.1, 0.01] {
        let mut params = Params::fast();
        params.solver.stop.rule = StopRule::Travel { net_residual, residual: None };
        let (x, report) = resolve(&scene, &y, params);
        assert!(report.converged, "{report:?}");
        // Internal forces cannot move the mean: its distance to the target is what the stopping rule allows.
        let lag = mean(&y) - mean(&x);
        assert!(
            lag.abs() < net_residual * mean_edge() + 0.03 * mean_edge(),
            "{lag} m from the target at {net_residual}"
        );
        assert!(report.net_residual_m < net_residual * mean_edge());
        assert!(report.max_stretch <= 1.1 * 1.02 + 1e-12, "{}", report.max_stretch);
    }
}

#[test]
fn a_sheet_torn_by_its_pins_does_not_disturb_another() {
    // Limits of 10 % contradict pins that stretch the sheet by 50 %: its multipliers grow without bound, and
    // those of the other sheet must not.
    let scene = sheets(6, &[0.0, 1.0], false);
    let n = scene.x.len() / 2;
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(20);
    let wanted = |p: &Point, stretch: f64| Point::new(stretch * p.x, p.y, p.z);
    let y: Vec<Point> =
        scene.x.iter().enumerate().map(|(v, p)| wanted(p, if v < n { 1.5 } else { 1.3 })).collect();
    let solve = |pinned: bool| {
        let prescribed: Vec<bool> =
            scene.x.iter().enumerate().map(|(v, p)| pinned && v < n && (p.x < 0.01 || p.x > 0.59)).collect();
        let masses = vec![1.0; scene.x.len()];
        let mut resolver = Resolver::new(scene.model.clone(), &scene.x, &masses, params.clone()).unwrap();
        let mut x = scene.x.clone();
        let input = ResolveInput { prescribed: &prescribed, ..ResolveInput::default() };
        let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
        (x, report)
    };
    let ((torn, report), (alone, calm)) = (solve(true), solve(false));
    assert!(report.max_stretch > 1.3, "the pins reach their targets");
    assert!(calm.converged, "{calm:?}");
    assert!(report.stationarity_m < 100.0 * mean_edge(), "{} m", report.stationarity_m);
    let apart = (n..2 * n).map(|v| (torn[v] - alone[v]).norm()).fold(0.0, f64::max);
    assert!(apart < 0.05 * mean_edge(), "{apart} m apart");
}

#[test]
fn limits_and_observers_stop_with_a_valid_state_and_the_distance_that_remains() {
    // The sheets bend and stretch through each other, which takes more than a few steps.
    let scene = sheets(4, &[0.0, 0.05], false);
    let y: Vec<Point> = (0..50)
        .map(|i| scene.x[49 - i] + Vector::new(0.0, 0.0, if i % 3 == 0 { 0.5 } else { -0.5 }))
        .collect();
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(2);
    let (_, report) = resolve(&scene, &y, params);
    assert_eq!(report.steps, 2);
    assert!(!report.converged && report.remaining_m > 0.0 && report.slowest_body.is_some());

    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![1.0; scene.x.len()], Params::fast()).unwrap();
    let mut x = scene.x.clone();
    let mut seen = 0;
    let mut previous = x.clone();
    let mut observer = |state: &AcceptedState<'_>| {
        assert_eq!(state.previous, &previous[..], "each state starts where the last one ended");
        previous = state.positions.to_vec();
        seen += 1;
        if seen == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let report = resolver.resolve_with(&mut x, &y, &ResolveInput::default(), &mut observer).unwrap();
    assert_eq!((report.steps, seen), (3, 3));
    assert_eq!(x, previous);

    let mut params = Params::fast();
    params.solver.stop.max_seconds = Some(1e-9);
    assert_eq!(resolve(&scene, &y, params).1.steps, 1);
}

#[test]
fn pins_go_to_their_target_and_wait_where_they_would_cut_through() {
    // A pinned sheet is pushed through a free sheet, which yields. If the other sheet is pinned as well, it
    // waits.
    let scene = sheets(4, &[0.0, 0.05], false);
    let n = scene.x.len() / 2;
    let y: Vec<Point> =
        scene.x.iter().enumerate().map(|(i, p)| if i < n { p + 0.2 * Vector::z() } else { *p }).collect();
    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![1.0; 2 * n], Params::fast()).unwrap();
    let mut run = |pinned: Vec<bool>| {
        let mut x = scene.x.clone();
        let input = ResolveInput { prescribed: &pinned, ..ResolveInput::default() };
        let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
        (x, report)
    };
    let (x, report) = run((0..2 * n).map(|i| i < n).collect());
    assert!(report.converged && report.prescribed_lag_m < 0.03 * mean_edge(), "{report:?}");
    assert!((0..n).all(|i| x[i + n].z > x[i].z + 1e-3));
    let (x, report) = run(vec![true; 2 * n]);
    assert!(!report.converged && report.prescribed_lag_m > 0.1, "{report:?}");
    assert!(report.steps < 60, "the call must not wait for what cannot move: {} steps", report.steps);
    assert!((0..n).all(|i| x[i + n].z > x[i].z));
}

#[test]
fn the_result_has_the_same_bits_for_any_number_of_threads_and_on_every_call() {
    let scene = sheets(12, &[0.0, 0.05, 0.1], false);
    let n = scene.x.len() / 3;
    let y: Vec<Point> = (0..3 * n).map(|i| scene.x[3 * n - 1 - i] + 0.01 * Vector::x()).collect();
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut params = Params::fast();
            params.solver.stop.max_steps = Some(12);
            let mut resolver =
                Resolver::new(scene.model.clone(), &scene.x, &vec![1.0; 3 * n], params).unwrap();
            let mut results = Vec::new();
            for _ in 0..2 {
                let mut x = scene.x.clone();
                resolver.resolve(&mut x, &y).unwrap();
                results.push(x);
            }
            assert!(results[0] == results[1], "the second call differs: state is carried over between calls");
            results.swap_remove(0)
        })
    };
    let one = run(1);
    for threads in [2, 3] {
        assert!(run(threads) == one, "{threads} threads give other bits");
    }
}

/// A plate rises through a free sheet and carries it along. With edges of 0.25 and of 0.05 of those of the
/// sheet it takes about as many steps.
#[test]
fn the_mesh_of_an_obstacle_hardly_matters() {
    let steps = |cells: usize| {
        let (mut x, mut triangles) = (Vec::new(), Vec::new());
        sheet(4, 0.1, 0.05, &mut x, &mut triangles);
        let n = x.len();
        sheet(cells, 0.4 / cells as f64, 0.0, &mut x, &mut triangles);
        let bodies = (0..x.len()).map(|v| u32::from(v >= n)).collect();
        let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
        let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
        let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
        let y: Vec<Point> =
            x.iter().enumerate().map(|(v, p)| if v < n { *p } else { p + 0.3 * Vector::z() }).collect();
        let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], Params::fast()).unwrap();
        let report = resolver.resolve(&mut x, &y).unwrap();
        assert!(report.converged && report.prescribed_lag_m == 0.0, "{report:?}");
        report.steps
    };
    let (coarse, fine) = (steps(16), steps(80));
    assert!(fine <= coarse + coarse / 4, "{coarse} steps with a coarse mesh, {fine} with a fine one");
}

#[test]
fn an_obstacle_waits_as_one_body() {
    // A rigid plate rises against a pinned sheet, which stops it.
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(4, 0.1, 0.05, &mut x, &mut triangles);
    let n = x.len();
    sheet(1, 0.4, 0.0, &mut x, &mut triangles);
    let bodies = (0..x.len()).map(|v| u32::from(v >= n)).collect();
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
    let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], Params::fast()).unwrap();
    let start = x.clone();
    let y: Vec<Point> =
        x.iter().enumerate().map(|(i, p)| if i >= n { p + Vector::z() } else { *p }).collect();
    let pinned: Vec<bool> = (0..x.len()).map(|i| i < n).collect();
    let input = ResolveInput { prescribed: &pinned, ..ResolveInput::default() };
    let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
    let risen: Vec<f64> = (n..x.len()).map(|i| x[i].z - start[i].z).collect();
    assert!(risen.iter().all(|r| (r - risen[0]).abs() < 1e-12), "{risen:?}");
    assert!(risen[0] > 0.01 && risen[0] < 0.05, "{risen:?}");
    assert!(report.prescribed_lag_m > 0.9);
}

/// A sheet whose pinned vertices are led onto and then below the top of a pyramid, which is just beside one
/// of them. The rows of triangles with that vertex have a short lever on the others.
#[test]
fn cloth_stays_where_it_is_when_its_pins_are_led_into_an_obstacle() {
    let edge = 0.1;
    for depth in [-0.005, 0.005, 0.05] {
        let (mut x, mut triangles) = (Vec::new(), Vec::new());
        sheet(8, edge, 0.02, &mut x, &mut triangles);
        let first = x.len();
        let pinned: Vec<usize> = vec![30, 31, 39, 40];
        let top = Point::new(x[30].x + 1e-4, x[30].y + 2e-4, 0.0);
        x.push(top);
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        x.extend(corners.map(|(a, b)| top + edge * Vector::new(a, b, -1.0)));
        let peak = first as u32;
        triangles.extend((0..4).map(|k| [peak, peak + 1 + k, peak + 1 + (k + 1) % 4]));
        let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
        let bodies = (0..x.len()).map(|v| u32::from(v >= first)).collect();
        let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
        let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
        let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], Params::fast()).unwrap();
        let fall = 0.02 + depth;
        let mut y = x.clone();
        y[..first].iter_mut().for_each(|p| p.z -= fall);
        let (mut prescribed, mut groups) = (vec![false; x.len()], vec![ResolveInput::NO_GROUP; x.len()]);
        for &v in &pinned {
            (prescribed[v], groups[v]) = (true, 0);
        }
        let input = ResolveInput { prescribed: &prescribed, groups: &groups, ..ResolveInput::default() };
        let report = resolver.resolve_with(&mut x, &y, &input, &mut ()).unwrap();
        // Nothing asks for more than to stay above the pyramid, by the contact distance of a tenth of an
        // edge.
        let far = (0..first).map(|v| (x[v] - y[v]).norm()).fold(0.0, f64::max);
        assert!(far < depth.max(0.0) + 0.25 * edge, "{depth}: {far}, {report:?}");
        assert!(report.steps <= 40, "{depth}: {} steps", report.steps);
        assert_eq!(report.prescribed_lag_m == 0.0, depth < 0.0, "{depth}: {report:?}");
    }
}

#[test]
fn prescribed_vertices_arrive_exactly_where_nothing_is_in_their_way() {
    // A small obstacle under a coarse sheet: a hundredth of the mean edge, at which a call may end, is large
    // beside its motion. Far below it moves freely; just below, trust regions make it take many steps.
    for (height, motion) in [(20.0, 0.2), (20.0, 3.0), (0.05, 0.1), (0.05, 1.0), (0.05, 10.0)] {
        let (mut x, mut triangles) = (Vec::new(), Vec::new());
        sheet(20, 0.5, height, &mut x, &mut triangles);
        let first = x.len();
        sheet(2, 0.1, 0.0, &mut x, &mut triangles);
        let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
        let bodies = (0..x.len()).map(|v| u32::from(v >= first)).collect();
        let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
        let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
        let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], Params::fast()).unwrap();
        let mut y = x.clone();
        y[first..].iter_mut().for_each(|p| p.x += motion);
        let report = resolver.resolve(&mut x, &y).unwrap();
        assert!(report.converged && report.prescribed_lag_m == 0.0, "{height}, {motion}: {report:?}");
        assert_eq!(x[first..], y[first..], "{height}, {motion}");
    }
}

#[test]
fn intersections_of_a_start_are_found() {
    let scene = sheets(4, &[0.0, 0.1], false);
    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![1.0; scene.x.len()], Params::fast()).unwrap();
    assert!(resolver.detect_intersections(&scene.x, 10).unwrap().is_clear());
    // The upper sheet is turned upright, through the lower one.
    let mut crossed = scene.x.clone();
    crossed[25..].iter_mut().for_each(|p| *p = Point::new(p.x, 0.21, 0.2 - p.y));
    let report = resolver.detect_intersections(&crossed, 3).unwrap();
    assert!(report.intersections.len() == 3 && report.intersection_count > 3, "{report:?}");
    let result = resolver.resolve(&mut crossed.clone(), &crossed);
    // Debug builds look at each start.
    let expected = report.intersection_count;
    let refused = matches!(result, Err(ResolveError::StartIntersects { count, .. }) if count == expected);
    assert_eq!(refused, cfg!(debug_assertions));
}

#[test]
fn a_time_step_that_is_none_is_refused() {
    let scene = sheets(1, &[1.0], false);
    let mut resolver = Resolver::new(scene.model.clone(), &scene.x, &[1.0; 4], Params::fast()).unwrap();
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let input = ResolveInput { time_step: Some(dt), ..ResolveInput::default() };
        let error = resolver.resolve_with(&mut scene.x.clone(), &scene.x, &input, &mut ()).unwrap_err();
        assert!(matches!(error, ResolveError::TimeStep(_)), "{dt}: {error}");
    }
}

#[test]
fn invalid_input_is_refused_with_its_name_and_leaves_the_state_unchanged() {
    let scene = sheets(1, &[1.0], false);
    let masses = vec![1.0; 4];
    let resolver = |masses: &[f64], params| Resolver::new(scene.model.clone(), &scene.x, masses, params);
    assert!(matches!(resolver(&[1.0; 3], Params::fast()), Err(ResolveError::Length { what: "masses", .. })));
    assert!(matches!(
        resolver(&[1.0, 0.0, 1.0, 1.0], Params::fast()),
        Err(ResolveError::Mass { vertex: 1, .. })
    ));
    let mut broken = Params::fast();
    broken.solver.forward.damping = 1.5;
    broken.contact.stretch_limit = Some(0.9);
    let Err(ResolveError::Params(errors)) = resolver(&masses, broken) else { panic!("accepted") };
    let paths: Vec<&str> = errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(
        paths,
        ["contact.stretch_limit", "solver.forward.damping"],
        "every error is reported: {errors}"
    );

    let mut good = resolver(&masses, Params::fast()).unwrap();
    let mut x = scene.x.clone();
    let mut y = scene.x.clone();
    y[2].y = f64::NAN;
    let error = good.resolve(&mut x, &y).unwrap_err();
    assert!(matches!(error, ResolveError::NonFinite { what: "the target", vertex: 2, .. }), "{error}");
    assert_eq!(x, scene.x);
    let mut far: Vec<Point> = scene.x.iter().map(|p| p + 1e13 * Vector::x()).collect();
    far[2].z = -2e13;
    let error = good.resolve(&mut x, &far).unwrap_err();
    assert!(
        matches!(
            error,
            ResolveError::MinSeparationBelowRounding { what: "the target", vertex: 2, coordinate: 2e13, .. }
        ),
        "{error}"
    );
    assert_eq!(x, scene.x);
}

#[test]
fn a_pair_that_starts_close_opens_slowly() {
    // Two sheets start at 1 % of delta. The call opens the gap by the separation speed and no more.
    let delta = 0.1 * mean_edge();
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(4, 0.1, 0.0, &mut x, &mut triangles);
    let n = x.len();
    sheet(4, 0.1, 0.01 * delta, &mut x, &mut triangles);
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let bodies = (0..x.len()).map(|v| u32::from(v >= n)).collect();
    let model = CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap();
    let scene = Scene { x, model };
    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![1.0; 2 * n], Params::fast()).unwrap();
    let mut x = scene.x.clone();
    let input = ResolveInput { time_step: Some(0.005), ..ResolveInput::default() };
    resolver.resolve_with(&mut x, &scene.x, &input, &mut ()).unwrap();
    // 20 delta per second for 1/200 s is a tenth of delta.
    let opened = (0..n).map(|i| x[n + i].z - x[i].z).fold(0.0, f64::max);
    assert!(opened > 0.05 * delta && opened < 0.2 * delta, "{}", opened / delta);
}
