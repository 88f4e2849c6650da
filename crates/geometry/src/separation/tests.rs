use super::*;

fn p(x: f64, y: f64, z: f64) -> Point {
    Point::new(x, y, z)
}

#[test]
fn the_width_is_just_below_the_distance() {
    let o = Point::origin();
    let above = p(0.25, 0.25, 1e-3);
    let triangle = [above, o, p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
    let edges = [p(0.0, 0.0, 1e-3), p(1.0, 0.0, 1e-3), p(0.5, -1.0, 0.0), p(0.5, 1.0, 0.0)];
    for (kind, points) in [
        (PairKind::VertexVertex, [p(0.0, 0.0, 1e-3), o, o, o]),
        (PairKind::VertexEdge, [p(0.5, 0.0, 1e-3), o, p(1.0, 0.0, 0.0), o]),
        (PairKind::VertexTriangle, triangle),
        (PairKind::EdgeEdge, edges),
    ] {
        let separation = separate(kind, &points);
        assert!(separation.width < 1e-3 && separation.width > 1e-3 - 4e-15, "{separation:?}");
        assert!((separation.normal - Vector::z()).norm() < 1e-12, "{separation:?}");
        assert!((separation.distance - 1e-3).abs() < 1e-17, "{separation:?}");
    }
}

#[test]
fn where_the_difference_of_closest_points_is_rounding_another_direction_certifies() {
    // Heights far below what the difference of the closest points can resolve as a direction.
    for height in [1e-10, 1e-12, 1e-13] {
        let tilt = |x: f64, y: f64, h: f64| p(x - 0.3 * h, y - 0.7 * h, 0.3 * x + 0.7 * y + h);
        let height = height / 1.58_f64.sqrt();
        let vertex =
            [tilt(0.31, 0.33, height), tilt(0.0, 0.1, 0.0), tilt(1.0, 0.0, 0.0), tilt(0.0, 1.0, 0.0)];
        let edges =
            [tilt(0.1, 0.2, height), tilt(0.7, 0.9, height), tilt(0.1, 0.8, 0.0), tilt(0.9, 0.3, 0.0)];
        for (kind, points) in [(PairKind::VertexTriangle, vertex), (PairKind::EdgeEdge, edges)] {
            let separation = separate(kind, &points);
            assert!(separation.width > 0.9 * height, "{kind:?} {height} {separation:?}");
        }
    }
}

#[test]
fn touching_and_coincident_pairs_have_no_width() {
    let o = Point::origin();
    for kind in PairKind::ALL {
        let separation = separate(kind, &[o; 4]);
        assert!(separation.width <= 0.0, "{kind:?} {separation:?}");
        assert_eq!(separation.normal.norm(), 1.0);
        assert_eq!(separation.distance, 0.0);
    }
    let (x, y) = (p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0));
    let inside = separate(PairKind::VertexTriangle, &[p(0.25, 0.25, 0.0), o, x, y]);
    let crossing = separate(PairKind::EdgeEdge, &[o, p(1.0, 1.0, 0.0), x, y]);
    // Everything on one line: its direction would give a width of minus the overlap.
    let on_edge = separate(PairKind::VertexEdge, &[p(0.5, 0.0, 0.0), o, x, o]);
    let along = separate(PairKind::EdgeEdge, &[p(0.25, 0.0, 0.0), p(0.75, 0.0, 0.0), o, x]);
    for separation in [inside, crossing, on_edge, along] {
        assert!(separation.width <= 0.0 && separation.width > -1e-14, "{separation:?}");
    }
}

#[test]
fn a_half_space_bounds_from_below_for_normals_of_any_length() {
    for (length, height) in [(1.0, 1e-3), (1.0 + 1e-12, 1e-6), (3.0, 0.5), (1e-3, -0.25)] {
        let n = Vector::new(1.0, 2.0, 2.0) / 3.0;
        let base = p(1e4, -3e3, 2e3);
        let plane = HalfSpace { normal: n * length, offset: n.dot(&base.coords) * length };
        let separation = separate_half_space(&(base + n * height), &plane);
        assert!((separation.distance - height).abs() < 1e-11, "{separation:?}");
        assert!(
            separation.width < separation.distance && separation.width > height - 3e-11,
            "{separation:?}"
        );
    }
    let nothing = HalfSpace { normal: Vector::zeros(), offset: 1.0 };
    assert_eq!(separate_half_space(&p(0.0, 0.0, 1.0), &nothing).width, 0.0);
}

#[test]
fn weights_are_signed_by_side() {
    let mut separation = undecided([1.0, 0.25, 0.25, 0.5]);
    assert_eq!(separation.signed_weights(PairKind::VertexTriangle), [1.0, -0.25, -0.25, -0.5]);
    assert_eq!(separation.signed_weights(PairKind::VertexHalfSpace), [1.0, 0.0, 0.0, 0.0]);
    separation.weights = [0.5, 0.5, 0.25, 0.75];
    assert_eq!(separation.signed_weights(PairKind::EdgeEdge), [0.5, 0.5, -0.25, -0.75]);
}
