//! Forward steps by continuous collision detection.

use crate::common::{Scene, assert_same_on_any_number_of_threads, resolve_watched};
use bowknot_baselines::barrier::{BarrierParams, DescentStep};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact, SweptSearch};
use bowknot_baselines::twoway::geometry::{Point, Topology, Vector};
use bowknot_baselines::twoway::proximity::{BodyFilter, CollisionModel};
use bowknot_baselines::twoway::{ForwardStep, LcpBackward, Params, ResolveInput, Resolver, Statistics};

const SLAB: AdditiveCcd = AdditiveCcd { slackness: 0.1, speed: ClosingSpeed::Slab, max_iterations: 1000 };

fn two_way<F: ForwardStep<SweptSearch>>(
    scene: &Scene,
    params: Params,
    forward: F,
) -> Resolver<SweptSearch, LcpBackward, F> {
    let collision = scene.collision_scene(params);
    let search = SweptSearch::new(&collision);
    Resolver::with_stages(collision, search, LcpBackward::new(), forward)
}

fn check(name: &str, scene: &Scene, x: &[Point], report: &Statistics) {
    assert!(report.contact_rows > 10, "{name}: they never met: {report:?}");
    let middle = x.len() / 4;
    assert!(x[middle].z < x[middle + x.len() / 2].z, "{name}: they passed through each other");
    let moved = (0..x.len()).filter(|&v| x[v] != scene.x[v]).count();
    assert!(moved > x.len() / 2, "{name}: only {moved} vertices moved");
}

#[test]
fn sheets_that_change_places_never_intersect_on_the_way() {
    let scene = Scene::two_sheets(4, 0.04);
    let target = scene.swapped();
    for (name, mut params) in [("fast", Params::fast()), ("paper", Params::paper())] {
        params.solver.stop.max_steps = Some(150);
        for ccd in [AdditiveCcd::default(), SLAB] {
            let what = format!("{name}, earliest, {:?}", ccd.speed);
            let mut resolver = two_way(&scene, params.clone(), EarliestImpact::new(ccd).unwrap());
            let (x, report) = resolve_watched(&mut resolver, &scene, &target, &what);
            assert_eq!(report.searches, report.steps + 1, "{what}");
            check(&what, &scene, &x, &report);

            let what = format!("{name}, per vertex, {:?}", ccd.speed);
            let mut resolver = two_way(&scene, params.clone(), PerVertexImpact::new(ccd).unwrap());
            let (x, report) = resolve_watched(&mut resolver, &scene, &target, &what);
            assert_eq!(report.searches, report.steps + 1, "{what}");
            check(&what, &scene, &x, &report);

            let what = format!("{name}, per vertex, log barrier, {:?}", ccd.speed);
            let collision = scene.collision_scene(params.clone());
            let step = DescentStep::new(&collision, BarrierParams::default()).unwrap();
            let search = SweptSearch::new(&collision);
            let mut resolver =
                Resolver::with_stages(collision, search, step, PerVertexImpact::new(ccd).unwrap());
            let (x, report) = resolve_watched(&mut resolver, &scene, &target, &what);
            assert_eq!(report.searches, report.steps + 1, "{what}");
            check(&what, &scene, &x, &report);
        }
    }
}

#[test]
fn free_flight_takes_one_step_for_all_vertices_and_an_edge_at_a_time_for_each() {
    let scene = Scene::two_sheets(3, 0.3);
    let target: Vec<Point> = scene.x.iter().map(|p| p + Vector::new(2.0, -1.0, 2.0)).collect();
    let (x, report) = resolve_watched(
        &mut two_way(&scene, Params::fast(), EarliestImpact::default()),
        &scene,
        &target,
        "earliest",
    );
    assert!(report.converged && report.steps == 1, "{report:?}");
    assert!(x.iter().zip(&target).all(|(x, y)| (x - y).norm() < 1e-12));
    let (x, report) = resolve_watched(
        &mut two_way(&scene, Params::fast(), PerVertexImpact::default()),
        &scene,
        &target,
        "per vertex",
    );
    // 3 m in edges of 0.1 to 0.14 m.
    assert!(report.converged && (20..40).contains(&report.steps), "{report:?}");
    assert!(x.iter().zip(&target).all(|(x, y)| (x - y).norm() < 1e-12));
}

#[test]
fn one_tight_pair_holds_up_all_vertices_or_its_own() {
    // Two particles that want to change places, and a third far away.
    let x = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [5.0, 0.0, 0.0]].map(Point::from).to_vec();
    let topology = Topology::builder(3).particles([0, 1, 2]).build().unwrap();
    let model = CollisionModel::new(topology, vec![0; 3], vec![BodyFilter::DEFORMABLE], vec![]).unwrap();
    let scene = Scene { x, model };
    let target = [[0.02, 0.0, 0.0], [0.0, 0.0, 0.0], [5.0, 0.1, 0.0]].map(Point::from);
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(1);
    let input = ResolveInput::default();
    let mut x = scene.x.clone();
    // A backward step without any rows: y is the target.
    params.contact.active = 1.0;
    params.contact.range = 1.0;
    params.contact.delta = Some(1e-3);
    two_way(&scene, params.clone(), EarliestImpact::default())
        .resolve_with(&mut x, &target, &input, &mut ())
        .unwrap();
    let gone = (x[2] - scene.x[2]).norm();
    assert!((gone - 0.45 * 0.1).abs() < 0.01 * 0.1, "{gone} m");
    let mut x = scene.x.clone();
    params.contact.delta = Some(0.1);
    two_way(&scene, params, PerVertexImpact::default())
        .resolve_with(&mut x, &target, &input, &mut ())
        .unwrap();
    assert!((x[2] - target[2]).norm() < 1e-12, "{}", x[2]);
    assert!(x[0].x < x[1].x, "{} {}", x[0], x[1]);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let scene = Scene::two_sheets(6, 0.04);
    let target = scene.swapped();
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(40);
    assert_same_on_any_number_of_threads(|| {
        let (mut common, mut own) = (scene.x.clone(), scene.x.clone());
        let input = ResolveInput::default();
        two_way(&scene, params.clone(), EarliestImpact::default())
            .resolve_with(&mut common, &target, &input, &mut ())
            .unwrap();
        two_way(&scene, params.clone(), PerVertexImpact::default())
            .resolve_with(&mut own, &target, &input, &mut ())
            .unwrap();
        [common, own]
    });
}

#[test]
fn parameters_out_of_their_range_are_refused() {
    let ccd = AdditiveCcd { max_iterations: 0, ..AdditiveCcd::default() };
    let errors = [EarliestImpact::new(ccd).err(), PerVertexImpact::new(ccd).err()];
    for error in errors {
        assert_eq!(error.expect("a refusal")[0].path, "max_iterations");
    }
}
