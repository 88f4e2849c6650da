//! Steps of single pairs: how far gaps may close, and the cases in which rounding matters.

use bowknot_geometry::{PairKind, Point, Vector, separation};
use bowknot_proximity::{CollisionModel, Pair, PairList};
use bowknot_stepper::{Contacts, Rounding, Stepper, TrustRegions};

fn vertex_over_triangle(height: f64) -> Vec<Point> {
    [[0.2, 0.2, height], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from).to_vec()
}

fn list() -> PairList {
    let pair = Pair { elements: [0, 0], vertices: [0, 1, 2, 3] };
    PairList::from_kinds([vec![], vec![], vec![pair], vec![], vec![]])
}

/// One step of the pair toward x + d with a minimum separation; the positions after it and the frozen pairs.
fn step(x: &[Point], d: &[Vector], min_separation: f64, planes: bool) -> (Vec<Point>, usize) {
    let (pairs, min_separations) = (list(), [min_separation]);
    let points = [x[0], x[1], x[2], x[3]];
    let separations = [separation::separate(PairKind::VertexTriangle, &points)];
    let contacts = Contacts { pairs: &pairs, separations: &separations, min_separations: &min_separations };
    let y: Vec<Point> = x.iter().zip(d).map(|(x, d)| x + d).collect();
    let mut stepper = Stepper::default();
    stepper.begin(x.len());
    stepper.set_target(x, &y);
    let frozen = if planes {
        stepper.limit_by_planes(&contacts, 0.9)
    } else {
        stepper.limit_by_distances(&contacts, 0.9)
    };
    let mut next = x.to_vec();
    stepper.advance(&mut next);
    (next, frozen)
}

#[test]
fn a_closing_pair_keeps_a_tenth_of_its_gap_above_the_minimum_separation() {
    let x = vertex_over_triangle(0.5);
    let d = [Vector::new(0.0, 0.0, -7.0), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    let (next, frozen) = step(&x, &d, 0.1, true);
    assert_eq!(frozen, 0);
    assert!((next[0].z - (0.1 + 0.1 * 0.4)).abs() < 1e-12, "{}", next[0].z);
}

#[test]
fn vertices_without_a_target_stay_and_a_call_need_not_be_begun() {
    let x = vertex_over_triangle(0.5);
    let mut stepper = Stepper::default();
    let mut next = x.clone();
    stepper.advance(&mut next);
    assert_eq!(next, x, "no target at all");
    assert_eq!(stepper.set_target(&x, &x[..3]), 4);
    stepper.advance(&mut next);
    assert_eq!(next, x, "too few targets");
    let y: Vec<Point> = x.iter().map(|x| x + Vector::z()).collect();
    assert_eq!(stepper.set_target(&x[..3], &y[..3]), 0);
    stepper.advance(&mut next);
    assert_eq!((&next[..3], next[3]), (&y[..3], x[3]), "three of four have targets");
    assert_eq!(stepper.remaining_fractions(), [0.0; 3]);
}

#[test]
fn sides_share_the_gap_by_their_speeds() {
    let x = vertex_over_triangle(1.0);
    let up = Vector::new(0.0, 0.0, 1.0);
    let (next, _) = step(&x, &[-3.0 * up, up, up, up], 0.0, true);
    assert!((next[0].z - (1.0 - 0.9 * 0.75)).abs() < 1e-12);
    assert!((next[1].z - 0.9 * 0.25).abs() < 1e-12);
}

#[test]
fn tangential_and_opening_motion_is_free_with_planes_and_bounded_without() {
    let x = vertex_over_triangle(0.01);
    let d = [Vector::new(0.1, 0.1, 0.2), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    let (free, _) = step(&x, &d, 0.001, true);
    assert!((free[0] - (x[0] + d[0])).norm() < 1e-15);
    let (bounded, _) = step(&x, &d, 0.0, false);
    let moved = (bounded[0] - x[0]).norm();
    assert!((moved - 0.45 * 0.01).abs() < 1e-12, "{moved}");
}

#[test]
fn a_pair_within_rounding_is_frozen_even_when_it_would_open() {
    let x = vertex_over_triangle(1e-17);
    let d = [Vector::new(0.0, 0.0, 1.0), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    for planes in [true, false] {
        let (next, frozen) = step(&x, &d, 0.0, planes);
        assert_eq!(frozen, 1);
        assert_eq!(next, x);
    }
}

#[test]
fn no_number_of_steps_closes_the_gap_without_a_minimum_separation() {
    // Far from the origin, where each update is rounded coarsely.
    let far = Vector::new(1e4, 1e4, 1e4);
    let mut x: Vec<Point> = vertex_over_triangle(1e-3).iter().map(|p| p + far).collect();
    let d = [Vector::new(1e-4, 2e-4, -1.0), Vector::zeros(), Vector::zeros(), Vector::zeros()];
    for _ in 0..2000 {
        (x, _) = step(&x, &d, 0.0, true);
        assert!(x[0].z > x[1].z, "crossed at {:?}", x[0]);
    }
    assert!(
        x[0].z - x[1].z <= 40.0 * Rounding::new(1e4).frozen,
        "it should have come near: {}",
        x[0].z - x[1].z
    );
}

#[test]
fn a_target_that_is_not_finite_is_ignored_and_counted() {
    let x = vertex_over_triangle(1.0);
    let mut stepper = Stepper::default();
    stepper.begin(4);
    let y = [Point::new(f64::NAN, 0.0, 0.0), x[1], Point::new(0.0, f64::INFINITY, 0.0), x[3]];
    assert_eq!(stepper.set_target(&x, &y), 2);
    let mut next = x.clone();
    stepper.advance(&mut next);
    assert_eq!(next, x);
}

#[test]
fn trust_regions_keep_a_vertex_in_its_ball_in_every_direction() {
    let mut trust_regions = TrustRegions { centers: vec![Point::origin()], radii: vec![1.0] };
    let mut x = Point::origin();
    let mut rng = fastrand::Rng::with_seed(1);
    let mut random = || 2.0 * rng.f64() - 1.0;
    let mut reached: f64 = 0.0;
    for k in 0..10_000 {
        let scale = 10f64.powi(k % 9 - 4);
        let d = Vector::new(random(), random(), random()) * scale;
        x += trust_regions.limit(0, &x, &d) * d;
        assert!(x.coords.norm() <= 1.0);
        reached = reached.max(x.coords.norm());
    }
    assert!(reached > 0.99, "the trust region should be usable: {reached}");
    trust_regions.radii[0] = 0.0;
    assert_eq!(trust_regions.limit(0, &Point::origin(), &Vector::x()), 0.0);
    assert_eq!(trust_regions.limit(0, &Point::origin(), &Vector::zeros()), 1.0);
}

#[test]
fn an_obstacle_moves_as_one() {
    use bowknot_geometry::Topology;
    use bowknot_proximity::BodyFilter;
    let x = vertex_over_triangle(0.5);
    let topology = Topology::builder(4).triangles([[1, 2, 3]]).particles([0]).build().unwrap();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, vec![0, 1, 1, 1], filters, vec![]).unwrap();
    let y: Vec<Point> = x.iter().map(|p| p + Vector::z()).collect();
    let mut stepper = Stepper::default();
    stepper.begin(4);
    stepper.set_target(&x, &y);
    stepper.limit(2, 0.25);
    assert_eq!(stepper.limit_by_bodies(&model, &[1, 2, 3]), 0.25);
    let mut next = x.clone();
    stepper.advance(&mut next);
    assert_eq!(next[0], y[0]);
    for v in 1..4 {
        assert_eq!(next[v], x[v] + 0.25 * Vector::z());
    }
}

/// The vertex wants to go a hundred times as far as the triangle. With capped travels both get half of the
/// gap that they can close, and the cap holds where no pair does.
#[test]
fn capped_travels_share_the_gap_and_no_vertex_goes_farther() {
    let x = vertex_over_triangle(0.1);
    let topology = bowknot_geometry::Topology::builder(4).triangles([[1, 2, 3]]).build().unwrap();
    let model = CollisionModel::single_body(topology);
    let up = Vector::z();
    let y = [x[0] - 100.0 * up, x[1] + up, x[2] + up, x[3] + up];
    let (pairs, min_separations) = (list(), [0.0]);
    let separations = [separation::separate(PairKind::VertexTriangle, &[x[0], x[1], x[2], x[3]])];
    let contacts = Contacts { pairs: &pairs, separations: &separations, min_separations: &min_separations };
    let step = |with_pair: bool| {
        let mut stepper = Stepper::default();
        stepper.begin(4);
        stepper.set_target(&x, &y);
        stepper.cap_travel(&model, &[], 0, |_| 0.06);
        assert!((stepper.cap(0) - 0.0006).abs() < 1e-15 && (stepper.cap(1) - 0.06).abs() < 1e-15);
        if with_pair {
            assert_eq!(stepper.limit_by_planes(&contacts, 0.9), 0);
        }
        let mut next = x.clone();
        stepper.advance(&mut next);
        [x[0].z - next[0].z, next[1].z]
    };
    let close = |found: [f64; 2], expected: f64| found.iter().all(|f| (f - expected).abs() < 1e-12);
    assert!(close(step(true), 0.045), "{:?}", step(true));
    assert!(close(step(false), 0.06), "{:?}", step(false));
    // The bounds of rounding hold for travels up to half of the coordinate that they are made for.
    let mut stepper = Stepper::default();
    stepper.begin(4);
    stepper.set_target(&x, &y);
    assert!((stepper.largest_coordinate() - 200.0).abs() < 1e-12, "{}", stepper.largest_coordinate());
}
