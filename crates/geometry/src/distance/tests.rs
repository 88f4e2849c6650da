use super::*;

fn p(x: f64, y: f64, z: f64) -> Point {
    Point::new(x, y, z)
}

fn check(kind: PairKind, points: [Point; 4], weights: [f64; 4], offset: [f64; 3]) {
    let closest = closest(kind, &points);
    assert_eq!(closest.weights, weights, "{kind:?} {points:?}");
    assert_eq!(closest.offset, Vector::from(offset), "{kind:?} {points:?}");
    assert_eq!(closest.distance, Vector::from(offset).norm(), "{kind:?} {points:?}");
}

#[test]
fn each_kind_finds_the_closest_points_of_a_plain_pair() {
    let o = Point::origin();
    check(PairKind::VertexVertex, [p(3.0, 4.0, 0.0), o, o, o], [1.0, 1.0, 0.0, 0.0], [3.0, 4.0, 0.0]);
    check(
        PairKind::VertexEdge,
        [p(0.25, 2.0, 0.0), o, p(1.0, 0.0, 0.0), o],
        [1.0, 0.75, 0.25, 0.0],
        [0.0, 2.0, 0.0],
    );
    check(
        PairKind::VertexTriangle,
        [p(0.25, 0.5, -2.0), o, p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)],
        [1.0, 0.25, 0.25, 0.5],
        [0.0, 0.0, -2.0],
    );
    check(
        PairKind::EdgeEdge,
        [p(0.0, 0.0, 1.0), p(4.0, 0.0, 1.0), p(1.0, -1.0, 0.0), p(1.0, 1.0, 0.0)],
        [0.75, 0.25, 0.5, 0.5],
        [0.0, 0.0, 1.0],
    );
}

#[test]
fn degenerate_elements_are_what_they_span() {
    let (o, x) = (Point::origin(), p(1.0, 0.0, 0.0));
    let a = p(0.5, 1.0, 0.0);
    check(PairKind::VertexEdge, [a, o, o, o], [1.0, 1.0, 0.0, 0.0], [0.5, 1.0, 0.0]);
    // Collinear triangle.
    check(PairKind::VertexTriangle, [a, o, p(2.0, 0.0, 0.0), x], [1.0, 0.75, 0.25, 0.0], [0.0, 1.0, 0.0]);
    check(PairKind::VertexTriangle, [a, x, x, x], [1.0, 1.0, 0.0, 0.0], [-0.5, 1.0, 0.0]);
    // Two points, a point and an edge, collinear edges apart, parallel edges side by side.
    check(PairKind::EdgeEdge, [a, a, x, x], [1.0, 0.0, 1.0, 0.0], [-0.5, 1.0, 0.0]);
    check(PairKind::EdgeEdge, [a, a, o, x], [1.0, 0.0, 0.5, 0.5], [0.0, 1.0, 0.0]);
    check(
        PairKind::EdgeEdge,
        [o, x, p(3.0, 0.0, 0.0), p(2.0, 0.0, 0.0)],
        [0.0, 1.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0],
    );
    let parallel = edge_edge([&o, &x], [&p(0.5, 1.0, 0.0), &p(1.5, 1.0, 0.0)]);
    assert_eq!(parallel.offset, Vector::new(0.0, -1.0, 0.0));
}

#[test]
fn distances_whose_squares_underflow_are_kept() {
    let (o, x) = (Point::origin(), p(1.0, 0.0, 0.0));
    for tiny in [1e-150, 1e-170, 1e-310, f64::from_bits(1)] {
        let beyond = p(-tiny, 0.0, 0.0);
        assert_eq!(vertex_vertex(&beyond, &o).distance, tiny);
        assert_eq!(vertex_edge(&beyond, [&o, &x]).distance, tiny);
        assert_eq!(vertex_edge(&beyond, [&x, &o]).distance, tiny);
        assert_eq!(vertex_triangle(&beyond, [&x, &p(1.0, 1.0, 0.0), &o]).distance, tiny);
        assert_eq!(edge_edge([&beyond, &p(-1.0, 0.0, 0.0)], [&o, &x]).distance, tiny);
    }
}

#[test]
fn points_that_are_not_finite_have_no_distance() {
    let points = [p(0.2, 0.3, 0.5), p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
    for kind in [PairKind::VertexVertex, PairKind::VertexEdge, PairKind::VertexTriangle, PairKind::EdgeEdge] {
        for bad in [f64::NAN, f64::INFINITY] {
            for place in 0..kind.vertex_count() {
                let mut points = points;
                points[place].y = bad;
                let closest = closest(kind, &points);
                assert!(
                    closest.distance.is_nan() || closest.distance == f64::INFINITY,
                    "{kind:?}: {closest:?}"
                );
            }
        }
    }
    let [a, b, c, d] = [p(f64::NAN, 0.0, 0.0), points[1], points[2], points[3]];
    assert!(vertex_triangle(&a, [&b, &c, &d]).distance.is_nan());
    assert!(vertex_triangle(&points[0], [&b, &a, &d]).distance.is_nan());
    assert!(edge_edge([&a, &b], [&c, &d]).distance.is_nan());
}
