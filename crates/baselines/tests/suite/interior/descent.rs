//! The log barrier by gradient descent.

use crate::common::{Scene, assert_same_on_any_number_of_threads, resolve_watched};
use bowknot_baselines::barrier::{BarrierParams, Scaling, barrier, by_descent};
use bowknot_baselines::twoway::Params;
use bowknot_baselines::twoway::geometry::Vector;

/// Where m/dt^2 (z - z0) + B'(z - floor) vanishes, by bisection.
fn analytic_height(stiffness: f64, wanted: f64, floor: f64, range: f64, strength: f64) -> f64 {
    let (mut low, mut high) = (floor, range);
    for _ in 0..200 {
        let z = 0.5 * (low + high);
        let force = stiffness * (z - wanted) + barrier(strength, z - floor, range - floor).slope;
        if force < 0.0 { low = z } else { high = z }
    }
    0.5 * (low + high)
}

#[test]
fn a_vertex_pushed_against_a_triangle_ends_where_the_barrier_balances_its_inertia() {
    let scene = Scene::vertex_above_triangle(0.05);
    let mut target = scene.x.clone();
    target[3].z = -0.03;
    for (name, params) in [("fast", Params::fast()), ("paper", Params::paper())] {
        for scaling in [Scaling::Mass, Scaling::Blocks] {
            for strength in [20.0, 2000.0] {
                let mut params = params.clone();
                params.contact.delta = Some(0.01);
                params.solver.stop.max_steps = Some(20_000);
                let collision = scene.collision_scene(params);
                let settings =
                    BarrierParams { strength, scaling, tolerance: 1e-9, ..BarrierParams::default() };
                let mut resolver = by_descent(collision, settings).unwrap();
                let what = format!("{name}, {scaling:?}, {strength}");
                let (x, report) = resolve_watched(&mut resolver, &scene, &target, &what);
                assert!(report.converged, "{what}: {report:?}");
                let floor = resolver.state().contacts.min_separations[0];
                assert!((floor > 0.0) == (name == "fast"), "{what}: {floor}");
                let expected = analytic_height(0.01 / 1e-4, -0.03, floor, 0.01, strength);
                assert!((x[3].z - expected).abs() < 1e-8, "{what}: {} m, expected {expected} m", x[3].z);
                assert!((x[3].xy() - scene.x[3].xy()).norm() < 1e-12, "{what}");
            }
        }
    }
}

#[test]
fn sheets_that_want_to_change_places_never_intersect_on_the_way() {
    let scene = Scene::two_sheets(4, 0.04);
    let target = scene.swapped();
    for (name, mut params) in [("fast", Params::fast()), ("paper", Params::paper())] {
        params.solver.stop.max_steps = Some(300);
        let mut resolver = by_descent(scene.collision_scene(params), BarrierParams::default()).unwrap();
        let (x, report) = resolve_watched(&mut resolver, &scene, &target, name);
        assert!(report.contact_rows > 10, "{name}: they never met: {report:?}");
        // At the rim they may pass beside each other.
        let middle = x.len() / 4;
        assert!(x[middle].z < x[middle + x.len() / 2].z, "{name}: they passed through each other");
        assert!(report.min_gap_m.unwrap() > 0.0, "{name}");
    }
}

#[test]
fn without_contacts_the_target_is_reached() {
    let scene = Scene::two_sheets(3, 0.3);
    let target: Vec<_> = scene.x.iter().map(|p| p + Vector::new(0.4, -0.3, 0.2)).collect();
    let mut resolver = by_descent(scene.collision_scene(Params::fast()), BarrierParams::default()).unwrap();
    let (x, report) = resolve_watched(&mut resolver, &scene, &target, "flight");
    assert!(report.converged);
    assert!(x.iter().zip(&target).all(|(x, y)| (x - y).norm() < 1e-12));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = Scene::two_sheets(6, 0.04);
    let target = scene.swapped();
    assert_same_on_any_number_of_threads(|| {
        let mut params = Params::fast();
        params.solver.stop.max_steps = Some(60);
        let mut resolver = by_descent(scene.collision_scene(params), BarrierParams::default()).unwrap();
        let mut x = scene.x.clone();
        resolver.resolve(&mut x, &target).unwrap();
        x
    });
}
