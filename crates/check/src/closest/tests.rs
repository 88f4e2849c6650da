use super::*;
use bowknot_geometry::distance;

/// Points on a small grid, so that many pairs are degenerate, parallel or touching.
fn pairs() -> Vec<[Point; 4]> {
    let mut random = fastrand::Rng::with_seed(1);
    let mut number = || f64::from(random.i8(-2..=2));
    (0..5000).map(|_| std::array::from_fn(|_| Point::new(number(), number(), 0.25 * number()))).collect()
}

#[test]
fn distances_are_those_of_the_solver() {
    let kinds = [PairKind::VertexVertex, PairKind::VertexEdge, PairKind::VertexTriangle, PairKind::EdgeEdge];
    for points in pairs() {
        for kind in kinds {
            let (own, other) = (closest(kind, &points), distance::closest(kind, &points));
            let difference = (own.distance() - other.distance).abs();
            assert!(difference < 1e-14, "{kind:?} {points:?}: {} {}", own.distance(), other.distance);
            let [a, b] = own.places();
            assert!(((a - b) - own.offset).norm() < 1e-14);
        }
    }
}

#[test]
fn the_common_normal_points_toward_side_a() {
    for points in pairs() {
        for kind in [PairKind::VertexTriangle, PairKind::EdgeEdge] {
            let normal = common_normal(kind, &points).expect("both kinds have one");
            assert!(normal.dot(&(points[0] - points[kind.side_a()])) >= 0.0);
        }
    }
}
