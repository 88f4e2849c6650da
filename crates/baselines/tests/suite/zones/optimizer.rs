use super::support::{crumpled, momenta, nearing, solve_clear};
use crate::common::Scene;
use bowknot_baselines::twoway::geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_baselines::twoway::proximity::{BodyFilter, CollisionModel};
use bowknot_baselines::twoway::{Params, ResolveInput, Resolver};
use bowknot_baselines::zones::{ImpactZones, ZoneGoal, ZoneParams, ZoneSolver};

fn zones(scene: &Scene, solver: ZoneSolver) -> ImpactZones {
    ImpactZones::new(scene.collision_scene(Params::fast()), ZoneParams { solver, ..ZoneParams::default() })
        .unwrap()
}

const SOLVERS: [ZoneSolver; 3] =
    [ZoneSolver::GaussSeidel, ZoneSolver::LinearSystem, ZoneSolver::AugmentedLagrangian];

#[test]
fn a_vertex_stops_at_its_contact_distance_above_a_triangle() {
    let scene = Scene::vertex_above_triangle(0.5);
    let collision = scene.collision_scene(Params::fast());
    let mut target = scene.x.clone();
    target[3] += Vector::new(0.3, -0.1, -1.0);
    for solver in SOLVERS {
        let (x, outcome) = solve_clear(&mut zones(&scene, solver), &scene, &target, &[]);
        assert!(outcome.converged && !outcome.failed);
        // Down to delta, and no further than needed from where it wanted to be.
        let expected = Point::new(target[3].x, target[3].y, collision.lengths().delta);
        assert!((x[3] - expected).norm() < 0.02 * collision.lengths().delta, "{solver:?}: {}", x[3]);
        assert_eq!(x[..3], scene.x[..3]);
    }
}

#[test]
fn as_published_a_vertex_that_meets_a_triangle_stops_along_its_normal() {
    let scene = Scene::vertex_above_triangle(0.5);
    let mut target = scene.x.clone();
    target[3] += Vector::new(0.3, -0.1, -1.0);
    let mut zones = zones(&scene, ZoneSolver::LinearSystem);
    (zones.params.goal, zones.params.tolerance) = (ZoneGoal::ZeroVelocity, 1e-9);
    let (x, outcome) = solve_clear(&mut zones, &scene, &target, &[]);
    assert!(outcome.converged && outcome.steps == 1, "{outcome:?}");
    // Nothing of its way down remains, and all of its way along the triangle.
    let expected = Point::new(target[3].x, target[3].y, 0.5);
    assert!((x[3] - expected).norm() < 1e-12, "{}", x[3]);

    // Two sheets of equal masses that meet go on together, with the mean of their velocities.
    let scene = Scene::two_sheets(3, 0.05);
    let n = scene.x.len() / 2;
    let target: Vec<Point> =
        (0..2 * n).map(|v| scene.x[v] + if v < n { 0.3 } else { 0.0 } * Vector::z()).collect();
    let mut zones = self::zones(&scene, ZoneSolver::LinearSystem);
    (zones.params.goal, zones.params.tolerance) = (ZoneGoal::ZeroVelocity, 1e-9);
    zones.params.max_sweeps = 5000;
    let (x, outcome) = solve_clear(&mut zones, &scene, &target, &[]);
    assert!(outcome.converged, "{outcome:?}");
    let off = (0..2 * n).map(|v| (x[v] - scene.x[v] - 0.15 * Vector::z()).norm()).fold(0.0, f64::max);
    assert!(off < 1e-6, "{off}");
}

#[test]
fn sheets_that_come_near_are_resolved_and_keep_their_momentum() {
    let scene = Scene::two_sheets(4, 0.05);
    let (n, target) = (scene.x.len() / 2, nearing(&scene));
    let mut counts = Vec::new();
    for solver in SOLVERS {
        let (x, outcome) = solve_clear(&mut zones(&scene, solver), &scene, &target, &[]);
        assert!(outcome.converged, "{solver:?}: {outcome:?}");
        assert_eq!(outcome.searches, outcome.steps + 1);
        counts.push(outcome.steps);
        // Each row pushes its two sides alike, along a line through both points at the impact.
        let ([p, _], [p_after, _]) = (momenta(&scene.x, &target), momenta(&scene.x, &x));
        if solver != ZoneSolver::AugmentedLagrangian {
            assert!((p - p_after).norm() < 1e-12 * n as f64, "{solver:?}");
        }
    }
    assert_eq!(counts, [1, 1, 1]);
}

#[test]
fn without_thickness_what_does_not_meet_may_end_near_and_with_it_keeps_its_distance() {
    let scene = Scene::vertex_above_triangle(0.5);
    let delta = scene.collision_scene(Params::fast()).lengths().delta;
    let mut target = scene.x.clone();
    target[3].z = 0.3 * delta;
    let mut thin = zones(&scene, ZoneSolver::GaussSeidel);
    let (x, outcome) = solve_clear(&mut thin, &scene, &target, &[]);
    assert_eq!((outcome.steps, outcome.converged), (0, true));
    assert_eq!(x, target);
    thin.params.thickness = 0.8;
    let (x, outcome) = solve_clear(&mut thin, &scene, &target, &[]);
    assert_eq!((outcome.steps, outcome.converged), (1, true));
    assert!((x[3].z - delta).abs() < 0.01 * delta, "{}", x[3].z);

    // Sheets pressed onto each other: whatever pair, of all that are near at the end.
    let scene = Scene::two_sheets(6, 0.05);
    let target = crumpled(&scene, 0.05, 7);
    let mut resolver =
        Resolver::new(scene.model.clone(), &scene.x, &vec![0.01; scene.x.len()], Params::fast()).unwrap();
    let delta = resolver.scene().lengths().delta;
    let mut gap = |thickness: f64| {
        let mut zones = zones(&scene, ZoneSolver::GaussSeidel);
        zones.params.thickness = thickness;
        let (x, outcome) = solve_clear(&mut zones, &scene, &target, &[]);
        assert!(outcome.converged);
        let contacts = resolver.detect_contacts(&x, &ResolveInput::default()).unwrap();
        let body = |v: u32| scene.model.vertex_body()[v as usize];
        let gaps = contacts.pairs.pairs().iter().zip(&contacts.separations);
        let between = gaps.filter(|(pair, _)| body(pair.vertices[0]) != body(pair.vertices[3]));
        between.map(|(_, separation)| separation.distance).fold(f64::INFINITY, f64::min)
    };
    assert!(gap(0.0) < 0.7 * delta && gap(0.8) > 0.799 * delta);
}

/// A vertex between two plates that close to less than twice its contact distance, as in a vice.
fn vice() -> (Scene, Vec<Point>, Vec<bool>) {
    let mut x = Vec::new();
    let corners = [[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0]];
    for height in [0.0, 1.0] {
        x.extend(corners.map(|[u, v]| Point::new(u, v, height)));
    }
    x.push(Point::new(0.1, 0.2, 0.5));
    let topology = Topology::builder(7).triangles([[0, 1, 2], [3, 4, 5]]).particles([6]).build().unwrap();
    let bodies = vec![BodyFilter::OBSTACLE, BodyFilter::OBSTACLE, BodyFilter::DEFORMABLE];
    let model = CollisionModel::new(topology, vec![0, 0, 0, 1, 1, 1, 2], bodies, vec![]).unwrap();
    let scene = Scene { x, model };
    let mut target = scene.x.clone();
    // The plates end 0.1 mm apart: in between, nothing is a tenth of its contact distance away from both.
    target[3..6].iter_mut().for_each(|y| y.z = 1e-4);
    (scene, target, vec![])
}

#[test]
fn where_nothing_satisfies_all_impacts_it_fails_and_nothing_has_moved() {
    let (scene, target, prescribed) = vice();
    for solver in SOLVERS {
        let mut zones = zones(&scene, solver);
        zones.params.max_iterations = 20;
        let (x, outcome) = solve_clear(&mut zones, &scene, &target, &prescribed);
        assert!(outcome.failed && !outcome.converged, "{solver:?}");
        assert_eq!(outcome.steps, 20);
        assert_eq!(x, scene.x);
    }
}

#[test]
fn keyframes_that_cut_through_a_pinned_vertex_make_it_fail() {
    let scene = Scene::vertex_above_triangle(0.5);
    let mut target = scene.x.clone();
    target[..3].iter_mut().for_each(|y| y.z += 1.0);
    let pinned = [false, false, false, true];
    let (x, outcome) = solve_clear(&mut zones(&scene, ZoneSolver::GaussSeidel), &scene, &target, &pinned);
    assert!(outcome.failed);
    assert_eq!(x, scene.x);
    // Free, it is pushed along.
    let (x, outcome) = solve_clear(&mut zones(&scene, ZoneSolver::GaussSeidel), &scene, &target, &[]);
    assert!(outcome.converged && x[3].z > 1.0);
}

/// Whether each solver fails within `max_iterations` rounds; a failed call moves nothing.
fn failures(scene: &Scene, target: &[Point], max_iterations: usize) -> [bool; 3] {
    SOLVERS.map(|solver| {
        let mut zones = zones(scene, solver);
        zones.params.max_iterations = max_iterations;
        let (x, outcome) = solve_clear(&mut zones, scene, target, &[]);
        assert_eq!(outcome.failed, x == scene.x);
        assert_eq!(outcome.failed, !outcome.converged);
        assert_eq!(outcome.failed, outcome.steps == max_iterations);
        outcome.failed
    })
}

#[test]
fn sheets_that_change_places_and_crumple_are_resolved_as_long_as_what_met_may_part() {
    // With the linear system, pairs that have met stick for the rest of the call, and crumpled sheets cannot
    // separate.
    let scene = Scene::two_sheets(6, 0.02);
    assert_eq!(failures(&scene, &crumpled(&scene, 0.05, 100), 30), [false, false, false]);
    assert_eq!(failures(&scene, &crumpled(&scene, 0.2, 100), 30), [false, true, false]);
}

#[test]
fn a_target_far_from_anything_possible_is_too_much_for_projected_zones_too() {
    // Noise of 32 edge lengths, three times the sheets.
    let scene = Scene::two_sheets(12, 0.02);
    let target = crumpled(&scene, 3.2, 100);
    let mut zones = zones(&scene, ZoneSolver::GaussSeidel);
    zones.params.max_iterations = 30;
    let (x, outcome) = solve_clear(&mut zones, &scene, &target, &[]);
    assert!(outcome.failed);
    assert_eq!(x, scene.x);
}

#[test]
fn a_limit_on_steps_counts_as_a_failure_and_bad_input_is_refused() {
    let (scene, target, _) = vice();
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(3);
    let mut zones = ImpactZones::new(scene.collision_scene(params), ZoneParams::default()).unwrap();
    let (_, outcome) = solve_clear(&mut zones, &scene, &target, &[]);
    assert!(outcome.failed && outcome.steps == 3);
    let mut x = scene.x.clone();
    let mut bad = target.clone();
    bad[6].x = f64::NAN;
    use bowknot_baselines::Method;
    assert!(zones.solve(&mut x, &bad, &Default::default()).is_err());
    assert!(zones.solve(&mut x, &target[..3], &Default::default()).is_err());
    assert_eq!(x, scene.x);
}

#[test]
fn the_ground_holds_what_falls_through_it() {
    let heap = Scene::heap(0.02);
    let mut target = heap.x.clone();
    // All but the obstacle.
    let count = target.len() - 3;
    target[..count].iter_mut().for_each(|y| y.z -= 0.03);
    let (x, outcome) = solve_clear(&mut zones(&heap, ZoneSolver::GaussSeidel), &heap, &target, &[]);
    assert!(outcome.converged, "{outcome:?}");
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    assert!(x.iter().all(|x| ground.signed_distance(x) > 0.0));
}
