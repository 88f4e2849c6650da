//! Steps toward random targets, by twins and by a device: nothing ever intersects, and both agree.
//!
//! | module | holds |
//! |---|---|
//! | `scene` | scenes and targets |
//! | `kernels` | kernels beside their twins |
//! | `sweeps` | sweeps of rows and edges, and the tables of `docs/gpu/collisions.md` about them |
//! | `bindings` | devices that bind little, or are lost |
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

mod bindings;
mod kernels;
mod scene;
mod sweeps;

use bowknot_check::{Judge, PathOptions};
use bowknot_geometry::{PairKind, Point};
use bowknot_gpu::{Call, Candidate, Constraints, Kind, NONE, TwinEngine};
use bowknot_proximity::{PairList, ProximitySearch};
use scene::{EDGE, MARGIN, STRETCH, Scene, assert_no_intersections, collision, hanging_sheet, scene, target};

#[test]
fn nothing_intersects_on_the_way_to_random_targets() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut hindered = false;
    for round in 0..4 {
        let mut scene = scene();
        let mut collision = collision(TwinEngine::new(), &scene, &Constraints::default());
        for _ in 0..3 {
            let target = target(&scene, &mut random);
            collision.begin(&Call::toward(&target)).unwrap();
            for step in 0..20 {
                let report = collision.step().unwrap();
                let before = std::mem::replace(&mut scene.x, collision.positions().unwrap());
                assert_no_intersections(&scene, &scene.x, &format!("round {round} step {step}"));
                let judge = Judge::from_model(&scene.model);
                let path = judge.check_path(&before, &scene.x, &PathOptions::default()).unwrap();
                assert!(path.is_clear(), "round {round} step {step}: {path:?}");
                assert_eq!(report.frozen, 0, "{report:?}");
                hindered |= report.pressing > 20;
            }
        }
    }
    assert!(hindered, "contacts must press");
}

/// Trust regions and boxes are integers of 32 bits too: radii up to an edge length, and margins.
#[test]
fn the_grid_has_room_for_edges_and_margins_that_are_larger_than_the_scene() {
    for scale in [1.0, 1e-3, 1e-6] {
        let mut scene = scene();
        scene.x.iter_mut().for_each(|x| *x = Point::from(scale * x.coords));
        let collision = collision(TwinEngine::new(), &scene, &Constraints::default());
        let half = collision.grid().quantum() * f64::from(1 << 29);
        assert!(half >= 4.0 * EDGE.max(MARGIN), "{scale}: {half}");
    }
}

/// Checks that all pairs within contact range at `x` are among the candidates; counts them by kind.
fn assert_complete(scene: &Scene, x: &[Point], candidates: &[Candidate]) -> [usize; 5] {
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    let radii = vec![MARGIN; x.len()];
    let mut search = ProximitySearch::new(&scene.model);
    search.search(&scene.model, x, &radii, &mut pairs, &mut separations);
    let mut kinds = [0; 5];
    for kind in PairKind::ALL {
        let here = match kind {
            PairKind::VertexVertex => Kind::VertexVertex,
            PairKind::VertexEdge => Kind::VertexEdge,
            PairKind::VertexTriangle => Kind::VertexTriangle,
            PairKind::EdgeEdge => Kind::EdgeEdge,
            PairKind::VertexHalfSpace => Kind::VertexHalfSpace,
        };
        for pair in &pairs.pairs()[pairs.range(kind)] {
            let [a, b] = pair.elements;
            kinds[here as usize] += 1;
            assert!(candidates.binary_search(&Candidate::new(here, a, b)).is_ok(), "{kind:?} {a} {b}");
        }
    }
    kinds
}

#[test]
fn every_pair_within_range_before_and_after_a_step_is_a_candidate() {
    let scene = scene();
    let mut collision = collision(TwinEngine::new(), &scene, &Constraints::default());
    let mut target = target(&scene, &mut fastrand::Rng::with_seed(3));
    // Down to the ground.
    target.iter_mut().for_each(|y| y.z -= 0.1);
    // Nothing has been searched for.
    assert_eq!(collision.end().unwrap().near, None);
    collision.begin(&Call::toward(&target)).unwrap();
    assert_eq!(collision.end().unwrap().near, None);
    let (mut x, mut kinds, mut most_near) = (scene.x.clone(), [0; 5], 0);
    for _ in 0..20 {
        let report = collision.step().unwrap();
        let candidates = collision.candidates().unwrap();
        assert_eq!(candidates.len(), report.candidates);
        assert!(candidates.windows(2).all(|two| two[0] != two[1]), "no pair twice");
        let after = collision.positions().unwrap();
        for x in [&x, &after] {
            let found = assert_complete(&scene, x, &candidates);
            (0..5).for_each(|k| kinds[k] += found[k]);
        }
        // Of the candidates, these are listed at the end of a call, and few others.
        let near = collision.end().unwrap().near.unwrap();
        assert!(near.iter().all(|pair| candidates.binary_search(pair).is_ok()), "a candidate each");
        let in_range: usize = assert_complete(&scene, &after, &near).iter().sum();
        assert!(near.len() <= in_range + in_range / 8 + 4, "{} of {in_range}", near.len());
        most_near = most_near.max(near.len());
        x = after;
    }
    assert!(kinds.iter().all(|count| *count > 0) && most_near > 400, "{kinds:?}, {most_near}");
    collision.place(&x).unwrap();
    assert_eq!(collision.end().unwrap().near, None);
}

/// However often the host looks at the end of a call, later steps have the same bits.
#[test]
fn steps_after_an_end_are_those_without_it() {
    let run = |looks: bool| {
        let scene = scene();
        let mut collision = collision(TwinEngine::new(), &scene, &Constraints::default());
        collision.begin(&Call::toward(&target(&scene, &mut fastrand::Rng::with_seed(9)))).unwrap();
        let step = |_| {
            let report = collision.step().unwrap();
            if looks {
                collision.end().unwrap();
            }
            report
        };
        let reports: Vec<_> = (0..8).map(step).collect();
        (reports, collision.end().unwrap())
    };
    assert!(run(false) == run(true));
}

#[test]
fn edges_stay_below_their_limits() {
    let n = 9;
    let (scene, pinned, target) = hanging_sheet(n, 1.0);
    let x = scene.x.clone();
    let constraints = Constraints { prescribed: &pinned, ..Constraints::default() };
    let mut collision = collision(TwinEngine::new(), &scene, &constraints);
    collision.begin(&Call::toward(&target)).unwrap();
    (0..60).for_each(|_| {
        collision.step().unwrap();
    });
    let end = collision.positions().unwrap();
    let stretch = |[a, b]: &[u32; 2]| {
        let length = |x: &[Point]| (x[*a as usize] - x[*b as usize]).norm();
        length(&end) / length(&x)
    };
    let worst = scene.model.topology().edges.iter().map(stretch).fold(0.0, f64::max);
    let lowest = end.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    let hanging = f64::from(n - 1) * EDGE * STRETCH;
    assert!(worst < 1.02 * STRETCH, "{worst}");
    assert!(lowest < -0.99 * hanging && lowest > -1.02 * hanging, "{lowest} {hanging}");
}

#[test]
fn bodies_that_move_as_one_stay_as_they_are() {
    let scene = scene();
    let mut random = fastrand::Rng::with_seed(7);
    let target = target(&scene, &mut random);
    // The strands are a group of pinned vertices.
    let is_strand = |v: usize| scene.model.vertex_body()[v] == 3;
    let groups: Vec<u32> = (0..scene.x.len()).map(|v| if is_strand(v) { 0 } else { NONE }).collect();
    let prescribed: Vec<bool> = (0..scene.x.len()).map(is_strand).collect();
    let constraints =
        Constraints { prescribed: &prescribed, groups: &groups, masses: &[], ..Constraints::default() };
    let mut collision = collision(TwinEngine::new(), &scene, &constraints);
    collision.begin(&Call::toward(&target)).unwrap();
    (0..10).for_each(|_| {
        collision.step().unwrap();
    });
    let end = collision.positions().unwrap();
    for body in [2, 3] {
        let vertices: Vec<usize> = (0..end.len()).filter(|&v| scene.model.vertex_body()[v] == body).collect();
        let share = |v: usize| (end[v] - scene.x[v]).norm() / (target[v] - scene.x[v]).norm();
        let first = share(vertices[0]);
        assert!(first > 0.01, "body {body}: {first}");
        for &v in &vertices {
            assert!((share(v) - first).abs() < 1e-4, "body {body}: {} {first}", share(v));
        }
    }
}
