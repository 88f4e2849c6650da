//! Against parry3d-f64 and parry3d 0.31.
//!
//! parry's segment-segment routine compares squared lengths and their products with an *absolute* epsilon
//! (2.2e-16 in f64, 1.2e-7 in f32; `closest_points_segment_segment.rs`): edges below about 1e-4 m in f64 and
//! below about 2 cm in f32 all count as parallel there. So pairs are compared at sizes near 1, and the last
//! test pins the difference at small sizes, with brute force as judge.

use crate::sampling::{KINDS, Random};
use bowknot_geometry::{PairKind, Point, distance};

/// A `distance` function by the parry crate of one precision.
macro_rules! parry_distance {
    ($name:ident, $parry:ident, $real:ty) => {
        fn $name(kind: PairKind, points: &[Point; 4]) -> f64 {
            use $parry::math::{Pose, Vector};
            use $parry::query::{PointQuery, details};
            use $parry::shape::{Segment, Triangle};
            let [a, b, c, d] = points.map(|p| Vector::new(p.x as $real, p.y as $real, p.z as $real));
            f64::from(match kind {
                PairKind::VertexVertex => (a - b).length(),
                PairKind::VertexEdge => Segment::new(b, c).distance_to_local_point(a, true),
                PairKind::VertexTriangle => Triangle::new(b, c, d).distance_to_local_point(a, true),
                PairKind::EdgeEdge => {
                    let (first, second) = (Segment::new(a, b), Segment::new(c, d));
                    let (s, t) = details::closest_points_segment_segment_with_locations(
                        &Pose::IDENTITY,
                        &first,
                        &second,
                    );
                    (first.point_at(&s) - second.point_at(&t)).length()
                }
                PairKind::VertexHalfSpace => unreachable!("no half-spaces here"),
            })
        }
    };
}

parry_distance!(distance_f64, parry3d_f64, f64);
parry_distance!(distance_f32, parry3d, f32);

/// The smallest distance over points of both sides, refined around the best points.
fn brute_force(kind: PairKind, points: &[Point; 4]) -> f64 {
    assert_eq!(kind, PairKind::EdgeEdge);
    let [a0, a1, b0, b1] = points;
    let (mut s, mut t, mut reach) = (0.5, 0.5, 0.5);
    let mut least = f64::INFINITY;
    for _ in 0..40 {
        let (s_mid, t_mid) = (s, t);
        for i in -10..=10 {
            for j in -10..=10 {
                let si = f64::clamp(s_mid + reach * f64::from(i) / 10.0, 0.0, 1.0);
                let tj = f64::clamp(t_mid + reach * f64::from(j) / 10.0, 0.0, 1.0);
                let d = (a0 + (a1 - a0) * si - (b0 + (b1 - b0) * tj)).norm();
                if d < least {
                    (least, s, t) = (d, si, tj);
                }
            }
        }
        reach *= 0.6;
    }
    least
}

fn random_pair(random: &mut Random, size: f64) -> [Point; 4] {
    // Rounded to f32, so that both precisions get the same points.
    [0; 4].map(|_| Point::from(random.vector(size)).map(|x| f64::from(x as f32)))
}

#[test]
fn distances_agree_in_general_position() {
    let mut random = Random::new(9);
    for _ in 0..200_000 {
        let points = random_pair(&mut random, 1.0);
        let kind = KINDS[random.below(4)];
        let ours = distance::closest(kind, &points).distance;
        let theirs = distance_f64(kind, &points);
        assert!((ours - theirs).abs() < 1e-11, "{kind:?} {points:?} {ours} {theirs}");
        let single = distance_f32(kind, &points);
        assert!((ours - single).abs() < 1e-3, "{kind:?} {points:?} {ours} {single}");
    }
}

#[test]
fn no_distance_exceeds_theirs_however_degenerate() {
    // Any two points that another implementation finds bound the distance from above.
    let mut random = Random::new(10);
    for _ in 0..200_000 {
        let points = crate::sampling::near_degenerate_pair(&mut random);
        let kind = KINDS[random.below(4)];
        let scale = points.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
        let ours = distance::closest(kind, &points).distance;
        let theirs = distance_f64(kind, &points);
        assert!(ours <= theirs + 1e-14 * scale, "{kind:?} {points:?} {ours} {theirs}");
    }
}

#[test]
fn short_edges_are_parallel_to_parry_and_not_to_us() {
    // Crossing edges of 5 micrometers, 1 micrometer apart.
    let size = 5e-6;
    let points = [
        Point::new(-size, 0.0, 1e-6),
        Point::new(size, 0.0, 1e-6),
        Point::new(0.2 * size, -size, 0.0),
        Point::new(0.1 * size, size, 0.0),
    ];
    let ours = distance::closest(PairKind::EdgeEdge, &points).distance;
    let judge = brute_force(PairKind::EdgeEdge, &points);
    assert!((ours - 1e-6).abs() < 1e-20 && (judge - 1e-6).abs() < 1e-12, "{ours} {judge}");
    let theirs = distance_f64(PairKind::EdgeEdge, &points);
    assert!(theirs > 2.0 * judge, "parry has changed: {theirs}; drop this test and compare at all sizes");

    // The same at 1 cm in single precision.
    let centimeter = points.map(|p| p * 1e3);
    let theirs = distance_f32(PairKind::EdgeEdge, &centimeter);
    assert!(theirs > 2e-3, "parry has changed: {theirs}; drop this test and compare at all sizes");
}
