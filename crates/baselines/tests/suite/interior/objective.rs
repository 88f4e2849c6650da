//! The log-barrier objective against finite differences.

use crate::common::{Draw, Scene, with_candidates};
use bowknot_baselines::barrier::{BarrierForm, BarrierParams, Derivatives, Objective};
use bowknot_baselines::twoway::constraints::EdgeReference;
use bowknot_baselines::twoway::geometry::{PairKind, Point, Vector};
use bowknot_baselines::twoway::{Params, TrustRegionSearch};

#[test]
fn gradient_is_that_of_the_value_for_every_kind_of_pair_and_long_edges() {
    for form in [BarrierForm::Paper, BarrierForm::Ipc] {
        compare_gradient(form);
    }
}

fn compare_gradient(form: BarrierForm) {
    let mut scene = Scene::heap(0.006);
    let mut params = Params::fast();
    params.contact.delta = Some(0.01);
    params.contact.edge_reference = EdgeReference::Start;
    // Particles are no neighbors at rest, which would shorten their barrier.
    let place = scene.x.clone();
    scene.x.iter_mut().for_each(|p| p.coords *= 4.0);
    let collision = scene.collision_scene(params);
    scene.x = place;
    let mut draw = Draw::new(11);
    scene.x.iter_mut().for_each(|p| *p += 1e-3 * draw.vector());
    let target: Vec<Point> = scene.x.iter().map(|p| p + 0.03 * draw.vector()).collect();
    let mut search = TrustRegionSearch::new(&collision);
    // Edges are measured against a start where they were shorter than now.
    let barrier = BarrierParams { form, edge_stiffness: 50.0, ..BarrierParams::default() };
    let mut objective = Objective::new(&collision, barrier).unwrap();
    if form == BarrierForm::Ipc {
        objective.set_strength(2e5);
    }
    let mut start = with_candidates(&collision, &mut search, &scene.x, &target);
    start.x.iter_mut().for_each(|p| *p = Point::from(0.85 * p.coords));
    objective.begin(&collision, &start);
    let state = with_candidates(&collision, &mut search, &scene.x, &target);

    let contacts = objective.contacts(&collision, &state);
    for kind in PairKind::ALL {
        assert!(contacts.iter().any(|c| c.kind == kind), "no {kind:?} within range");
    }
    assert_eq!(contacts.iter().any(|c| c.mollifier.fades()), form == BarrierForm::Ipc);
    assert!(objective.long_edges(&state.x).count() > 10);
    let mut derivatives = Derivatives::default();
    objective.derivatives(&collision, &state, &state.x, &contacts, &mut derivatives);
    let energy =
        |x: &[Point]| objective.value(&collision, &state, x, &objective.contacts_at(&collision, &state, x));
    assert_eq!(energy(&state.x), objective.value(&collision, &state, &state.x, &contacts));
    let h = 1e-8;
    let mut largest = 0.0f64;
    for v in 0..state.x.len() {
        for k in 0..3 {
            let moved = |sign: f64| {
                let mut x = state.x.clone();
                x[v][k] += sign * h;
                energy(&x)
            };
            let expected = if state.is_movable(v) { (moved(1.0) - moved(-1.0)) / (2.0 * h) } else { 0.0 };
            let found = derivatives.gradient[v][k];
            largest = largest.max(found.abs());
            assert!((found - expected).abs() < 1e-4 * (1.0 + expected.abs()), "{v}.{k}: {found} {expected}");
        }
    }
    assert!(largest > 0.5, "{largest} N");
}

#[test]
fn blocks_majorise_the_convex_part_along_any_direction() {
    // Vertices at different distances above one triangle: their barriers' curvature along random directions.
    let scene = Scene::heap(0.006);
    let mut params = Params::fast();
    params.contact.delta = Some(0.01);
    let collision = scene.collision_scene(params);
    let mut search = TrustRegionSearch::new(&collision);
    let state = with_candidates(&collision, &mut search, &scene.x, &scene.x);
    let mut objective = Objective::new(&collision, BarrierParams::default()).unwrap();
    objective.begin(&collision, &state);
    let contacts = objective.contacts(&collision, &state);
    let mut derivatives = Derivatives::default();
    objective.derivatives(&collision, &state, &state.x, &contacts, &mut derivatives);
    let mut draw = Draw::new(3);
    for _ in 0..50 {
        let free = |v: usize| f64::from(u8::from(state.is_movable(v)));
        let u: Vec<Vector> = (0..state.x.len()).map(|v| free(v) * draw.vector()).collect();
        let mut convex = 0.0;
        for contact in &contacts {
            let signed = contact.separation.signed_weights(contact.kind);
            let opening: f64 = (0..contact.kind.vertex_count())
                .map(|k| signed[k] * contact.separation.normal.dot(&u[contact.vertices[k] as usize]))
                .sum();
            convex += contact.jet.curvature * opening * opening;
        }
        let bound: f64 = (0..u.len())
            .map(|v| {
                let inertia = objective.inertia(&collision, &state, v) * u[v].norm_squared();
                u[v].dot(&(derivatives.blocks[v] * u[v])) - if state.is_movable(v) { inertia } else { 0.0 }
            })
            .sum();
        assert!(convex > 0.0 && convex <= bound * (1.0 + 1e-12), "{convex} {bound}");
    }
}

#[test]
fn every_wrong_parameter_is_named() {
    let collision = Scene::two_sheets(1, 0.05).collision_scene(Params::fast());
    let params = BarrierParams {
        strength: -1.0,
        range: Some(1.0),
        time_step: 0.0,
        edge_stiffness: f64::NAN,
        tolerance: f64::INFINITY,
        ..BarrierParams::default()
    };
    let errors = Objective::new(&collision, params).expect_err("five fields are out of their range");
    let paths: Vec<&str> = errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(paths, ["strength", "time_step", "edge_stiffness", "tolerance", "range"]);
}
