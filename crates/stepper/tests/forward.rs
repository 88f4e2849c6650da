//! The composed step: what it guarantees beside its pairs, and what it refuses.

use bowknot_errors::Parameters;
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_stepper::{Bound, Forward, ForwardError, ForwardOptions};

/// A triangle on the ground and a particle above it.
fn start(height: f64) -> Vec<Point> {
    [[0.2, 0.2, height], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::from).to_vec()
}

fn topology() -> Topology {
    Topology::builder(4).triangles([[1, 2, 3]]).particles([0]).build().expect("a topology")
}

fn model() -> CollisionModel {
    CollisionModel::single_body(topology())
}

fn apart(min_separation: f64) -> ForwardOptions {
    ForwardOptions { min_separation, ..ForwardOptions::default() }
}

/// Both sides of the pair toward each other, far beyond.
fn through(x: &[Point]) -> Vec<Point> {
    let z = 1e3 * Vector::z();
    vec![x[0] - z, x[1] + z, x[2] + z, x[3] + z]
}

#[test]
fn a_pair_that_is_not_listed_keeps_the_minimum_separation() {
    // Within reach of both sides, their radii and the minimum separation, is 0.21.
    for (height, listed) in [(0.2101, 0), (0.2099, 1), (0.201, 1)] {
        let x = start(height);
        let mut forward = Forward::new(model(), x.clone(), &[0.1; 4], apart(0.01)).unwrap();
        assert_eq!(forward.contacts().pairs.len(), listed, "{height}");
        for _ in 0..60 {
            forward.advance(&through(&x)).unwrap();
        }
        let gap = forward.positions()[0].z - forward.positions()[1].z;
        assert!((0.01..0.0104).contains(&gap), "{height}: {gap}");
    }
}

/// Targets a billion meters away or farther leave as much room as near ones.
#[test]
fn far_targets_freeze_nothing() {
    for bound in [Bound::Planes, Bound::Isotropic] {
        for distance in [1.0, 1e9, 1e150] {
            let options = ForwardOptions { bound, ..apart(1e-9) };
            let x = start(1e-6);
            let mut forward = Forward::new(model(), x.clone(), &[0.1; 4], options).unwrap();
            let y = [x[0] - distance * Vector::z(), x[1], x[2], x[3]];
            for _ in 0..40 {
                assert_eq!(forward.advance(&y).unwrap().frozen_pairs, 0);
            }
            let gap = forward.positions()[0].z;
            assert!((1e-9..1.1e-9).contains(&gap), "{bound:?} {distance}: {gap}");
        }
    }
}

#[test]
fn vertices_go_as_far_as_their_radii_and_a_search_is_due_then() {
    let x = start(1.0);
    let y = [x[0] + 0.25 * Vector::z(), x[1], x[2], x[3]];
    let mut forward = Forward::new(model(), x, &[0.1; 4], apart(0.0)).unwrap();
    let report = forward.advance(&y).unwrap();
    assert!(report.search_due && (report.largest_move - 0.1).abs() < 2e-4, "{report:?}");
    assert_eq!(report.slowest, Some(0));
    assert!((report.remaining - 0.15).abs() < 2e-4);
    for _ in 0..2 {
        forward.search(&[0.1; 4]).unwrap();
        forward.advance(&y).unwrap();
    }
    let report = forward.advance(&y).unwrap();
    assert!(!report.search_due && report.slowest.is_none() && forward.positions()[0] == y[0], "{report:?}");

    // A vertex without a radius rests until a search gives it one.
    let x = start(1.0);
    let y = [x[0] + 0.25 * Vector::z(), x[1], x[2], x[3]];
    let mut forward = Forward::new(model(), x.clone(), &[0.0; 4], apart(0.0)).unwrap();
    let report = forward.advance(&y).unwrap();
    assert!(report.search_due && forward.positions() == x, "{report:?}");
}

/// Far from the origin a position is rounded by much of a small radius, and by another part of it in each
/// step.
#[test]
fn rounding_takes_no_vertex_out_of_its_ball_in_any_number_of_steps() {
    let ulp = f64::EPSILON * 2.0 * 1e4;
    let far = Vector::new(1e4, 1e4, 1e4);
    let mut rng = fastrand::Rng::with_seed(3);
    for radius in [0.3 * ulp, 3.0 * ulp, 30.0 * ulp, 3e4 * ulp] {
        let x: Vec<Point> = start(1.0).iter().map(|p| p + far).collect();
        let mut forward = Forward::new(model(), x.clone(), &[radius; 4], apart(0.0)).unwrap();
        let mut farthest = 0.0f64;
        for _ in 0..5_000 {
            let mut random = || Vector::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5);
            let y: Vec<Point> = x.iter().map(|p| p + 8.0 * radius * random()).collect();
            forward.advance(&y).unwrap();
            let moved = forward.positions().iter().zip(&x).map(|(p, x)| (p - x).norm());
            farthest = moved.fold(farthest, f64::max);
        }
        assert!(farthest <= radius + 2.0 * ulp, "{} of {} ulp", farthest / ulp, radius / ulp);
    }
}

#[test]
fn pairs_that_touch_at_the_start_are_frozen() {
    let x = start(0.0);
    let up = [x[0] + Vector::z(), x[1], x[2], x[3]];
    let mut forward = Forward::new(model(), x.clone(), &[0.1; 4], apart(0.0)).unwrap();
    assert_eq!(forward.advance(&up).unwrap().frozen_pairs, 1);
    assert_eq!(forward.positions(), x);
}

#[test]
fn an_obstacle_moves_as_one_and_not_without_all_its_targets() {
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology(), vec![0, 1, 1, 1], filters, vec![]).unwrap();
    let x = start(0.5);
    let mut forward = Forward::new(model, x.clone(), &[0.3, 0.1, 0.3, 0.3], apart(0.0)).unwrap();
    // It turns, so that the displacements differ; the vertex with the smallest radius limits all.
    let y = [x[0], x[1] - Vector::z(), x[2] - 2.0 * Vector::z(), x[3] - Vector::x()];
    forward.advance(&y).unwrap();
    let share = -forward.positions()[1].z;
    assert!((0.0999..0.1).contains(&share), "{share}");
    for v in 1..4 {
        assert!((forward.positions()[v] - (x[v] + share * (y[v] - x[v]))).norm() < 1e-15);
    }
    let before = forward.positions().to_vec();
    let y = [x[0] + Vector::x(), x[1], Point::new(f64::NAN, 0.0, 0.0), x[3]];
    let report = forward.advance(&y).unwrap();
    assert_eq!((report.not_finite, &forward.positions()[1..]), (1, &before[1..]));
    assert!(forward.positions()[0] != before[0]);
}

#[test]
fn minimum_separations_of_pairs_hold_until_the_next_search() {
    let x = start(0.1);
    let mut forward = Forward::new(model(), x.clone(), &[0.2; 4], apart(1e-3)).unwrap();
    assert_eq!(forward.contacts().min_separations, [1e-3]);
    forward.min_separations_mut()[0] = 0.05;
    for _ in 0..30 {
        forward.advance(&through(&x)).unwrap();
    }
    let contacts = forward.contacts();
    assert!((contacts.separations[0].width - 0.05).abs() < 1e-9, "{}", contacts.separations[0].width);
    forward.search(&[0.2; 4]).unwrap();
    assert_eq!(forward.contacts().min_separations, [1e-3]);
    for bad in [-1e-300, f64::NAN] {
        forward.min_separations_mut()[0] = bad;
        assert!(matches!(forward.advance(&x), Err(ForwardError::MinSeparation { pair: 0, .. })));
    }
}

#[test]
fn geometry_is_that_of_the_present_positions() {
    let x = start(0.1);
    let mut forward = Forward::new(model(), x.clone(), &[0.05; 4], apart(0.0)).unwrap();
    assert!((forward.contacts().separations[0].distance - 0.1).abs() < 1e-15);
    forward.advance(&[x[0] - 0.02 * Vector::z(), x[1], x[2], x[3]]).unwrap();
    assert!((forward.contacts().separations[0].distance - 0.08).abs() < 1e-15);
    forward.restart(&start(0.07), &[0.05; 4]).unwrap();
    assert!((forward.contacts().separations[0].distance - 0.07).abs() < 1e-15);
    assert_eq!(forward.trust_regions().centers, start(0.07));
    assert_eq!(forward.into_parts().1, start(0.07));
}

#[test]
fn what_a_search_would_leave_out_is_refused() {
    let new = |x: Vec<Point>, radii: &[f64]| Forward::new(model(), x, radii, apart(0.0));
    let x = start(0.1);
    for bad in [f64::NAN, f64::INFINITY, 2e14] {
        let mut moved = x.clone();
        moved[2].y = bad;
        assert!(matches!(new(moved, &[0.1; 4]), Err(ForwardError::Position { vertex: 2, .. })), "{bad}");
    }
    for bad in [f64::NAN, f64::INFINITY, -1e-9, 2e14, 1e-200] {
        let refused = new(x.clone(), &[0.1, 0.1, 0.1, bad]);
        assert!(matches!(refused, Err(ForwardError::Radius { vertex: 3, .. })), "{bad}");
    }
    assert!(matches!(new(x[..3].to_vec(), &[0.1; 4]), Err(ForwardError::Length { given: 3, .. })));
    assert!(matches!(new(x.clone(), &[0.1; 5]), Err(ForwardError::Length { given: 5, .. })));

    let mut broken = topology();
    broken.surface_vertices.pop();
    let refused = Forward::new(CollisionModel::single_body(broken), x.clone(), &[0.1; 4], apart(0.0));
    assert!(matches!(refused, Err(ForwardError::Topology)));
    let of_plane = |half_space| {
        let filters = vec![BodyFilter::DEFORMABLE];
        let model = CollisionModel::new(topology(), vec![0; 4], filters, vec![half_space]).unwrap();
        Forward::new(model, x.clone(), &[0.1; 4], apart(0.0))
    };
    let ground = HalfSpace { normal: Vector::z(), offset: -1.0 };
    assert!(of_plane(ground).is_ok() && of_plane(ground.absent()).is_ok());
    for (factor, offset) in
        [(100.0, -1.0), (0.0, -1.0), (f64::NAN, -1.0), (1.0, f64::NAN), (1.0, f64::INFINITY)]
    {
        let refused = of_plane(HalfSpace { normal: factor * Vector::z(), offset });
        assert!(matches!(refused, Err(ForwardError::HalfSpace { half_space: 0 })), "{factor} {offset}");
    }
    for (damping, min_separation) in [(1.0, 0.0), (0.0, 0.0), (f64::NAN, 0.0), (0.9, -1.0), (0.9, f64::NAN)] {
        let options = ForwardOptions { damping, min_separation, ..ForwardOptions::default() };
        let refused = Forward::new(model(), x.clone(), &[0.1; 4], options);
        assert!(matches!(refused, Err(ForwardError::Options(_))), "{damping} {min_separation}");
    }
    assert!(ForwardOptions::default().validate().is_ok());
}

#[test]
fn an_error_changes_nothing() {
    let x = start(0.1);
    let mut forward = Forward::new(model(), x.clone(), &[0.2; 4], apart(0.0)).unwrap();
    forward.advance(&[x[0] - 0.02 * Vector::z(), x[1], x[2], x[3]]).unwrap();
    let before = forward.positions().to_vec();
    assert!(forward.advance(&x[..3]).is_err());
    assert!(forward.search(&[f64::NAN; 4]).is_err() && forward.search(&[0.1; 3]).is_err());
    assert!(forward.restart(&x[..3], &[0.1; 4]).is_err() && forward.restart(&x, &[-1.0; 4]).is_err());
    assert_eq!(forward.positions(), before);
    assert_eq!((&forward.trust_regions().centers, &forward.trust_regions().radii[..]), (&x, &[0.2; 4][..]));
    assert_eq!(forward.contacts().pairs.len(), 1);
    // Coordinates grow until a search refuses them. The list still holds.
    let far = start(1e13);
    let mut forward = Forward::new(model(), far.clone(), &[9e13; 4], apart(0.0)).unwrap();
    let away: Vec<Point> = far.iter().map(|p| p + 1e15 * Vector::x()).collect();
    forward.advance(&away).unwrap();
    forward.search(&[9e13; 4]).unwrap();
    forward.advance(&away).unwrap();
    assert!(matches!(forward.search(&[1.0; 4]), Err(ForwardError::Position { .. })));
    assert_eq!(forward.trust_regions().radii, [9e13; 4]);
    forward.advance(&away).unwrap();
}
