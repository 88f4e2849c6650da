//! The certified width of any pair never exceeds the true distance.

use super::Draw;
use bowknot_geometry::separation::{self, Separation};
use bowknot_geometry::{HalfSpace, PairKind, Point, Vector, intersection};

/// Half of a unit in the last place, 2^-53.
const ROUNDING: f64 = 0.5 * f64::EPSILON;
/// Largest error of a computed distance, in rounding units of the largest coordinate difference of the pair.
const DISTANCE_ROUNDING: f64 = 8.0;

/// Checks the contact geometry of a pair of any kind at any finite points. Nothing is NaN. The width is at
/// most the distance, up to the error of the distance, and at most zero if the sides share a point by an
/// exact test.
pub fn separate(data: &[u8]) -> bool {
    let mut draw = Draw::new(data);
    let Some(kind) = draw.pick(&PairKind::ALL) else { return false };
    let points = points(&mut draw);
    if kind == PairKind::VertexHalfSpace {
        let half_space = HalfSpace { normal: points[1].coords, offset: points[2].x };
        let separation = separation::separate_half_space(&points[0], &half_space);
        check_numbers(&separation);
        assert!(separation.width <= separation.distance, "{half_space:?}, {:?}: {separation:?}", points[0]);
        return true;
    }
    let separation = separation::separate(kind, &points);
    check_numbers(&separation);
    check_weights(kind, &separation.weights);

    let used = &points[..kind.vertex_count()];
    let extent =
        used.iter().flat_map(|p| used.iter().map(move |q| (0.5 * p - 0.5 * q).amax())).fold(0.0, f64::max);
    // Both terms may be infinite; then nothing is checked.
    let known = separation.distance + 2.0 * extent * DISTANCE_ROUNDING * ROUNDING + f64::MIN_POSITIVE;
    assert!(separation.width <= known, "{kind:?} {points:?}: {separation:?}");
    if used.iter().all(is_in_exact_range) && share_a_point(kind, &points) {
        assert!(separation.width <= 0.0, "{kind:?} {points:?} touch: {separation:?}");
    }
    true
}

/// Four points: on a coarse grid, near one, far from the origin, or with any coordinates.
fn points(draw: &mut Draw<'_>) -> [Point; 4] {
    let style = draw.below(4);
    let (scale, offset) = (draw.power(100), draw.grid() * draw.power(30));
    std::array::from_fn(|_| {
        let coordinates: [f64; 3] = std::array::from_fn(|_| match style {
            0 => draw.grid(),
            1 => scale * (draw.grid() + 1e-15 * draw.grid()),
            2 => offset + draw.grid(),
            _ => draw.finite(),
        });
        Point::from(coordinates)
    })
}

fn check_numbers(separation: &Separation) {
    let Separation { normal, weights, distance, width } = separation;
    assert!(normal.iter().chain(weights).all(|number| number.is_finite()), "{separation:?}");
    assert!(!distance.is_nan() && !width.is_nan(), "{separation:?}");
    assert!((normal.norm() - 1.0).abs() <= 8.0 * ROUNDING, "{separation:?}");
}

fn check_weights(kind: PairKind, weights: &[f64; 4]) {
    assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{kind:?} {weights:?}");
    let (a, b) = weights[..kind.vertex_count()].split_at(kind.side_a());
    for side in [a, b] {
        assert!((side.iter().sum::<f64>() - 1.0).abs() <= 8.0 * ROUNDING, "{kind:?} {weights:?}");
    }
}

fn is_in_exact_range(point: &Point) -> bool {
    point.iter().all(|c| *c == 0.0 || (1e-90..1e100).contains(&c.abs()))
}

/// Whether the two sides share a point, decided exactly.
fn share_a_point(kind: PairKind, [p0, p1, p2, p3]: &[Point; 4]) -> bool {
    match kind {
        PairKind::VertexVertex => p0 - p1 == Vector::zeros(),
        PairKind::VertexEdge => intersection::point_on_edge(p0, [p1, p2]),
        PairKind::VertexTriangle => intersection::point_on_triangle(p0, [p1, p2, p3]),
        PairKind::EdgeEdge => intersection::edge_edge([p0, p1], [p2, p3]),
        PairKind::VertexHalfSpace => false,
    }
}
