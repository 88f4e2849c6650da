use super::*;
use bowknot_geometry::separation;

const H: f64 = 0.01;
const D: f64 = 0.001;

fn radius(kind: PairKind, points: [[f64; 3]; 4]) -> f64 {
    let x = points.map(Point::from);
    let origin = origin(kind, &separation::separate(kind, &x), &[0, 1, 2, 3], &x);
    curvature_radius(origin, D, H)
}

#[test]
fn a_normal_turns_with_edges_above_a_face_and_with_the_distance_at_vertices() {
    let triangle = [[0.0, 0.0, 0.0], [H, 0.0, 0.0], [0.0, H, 0.0]];
    let over =
        |x: f64, y: f64| radius(PairKind::VertexTriangle, [[x, y, D], triangle[0], triangle[1], triangle[2]]);
    assert_eq!(over(0.2 * H, 0.2 * H), H);
    assert_eq!(over(0.4 * H, -D), D, "beside an edge");
    assert_eq!(over(-D, -D), D, "beside a corner");
}

#[test]
fn the_more_parallel_two_edges_are_the_faster_their_normal_turns() {
    let crossed = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let along = [0.5 * H * c, 0.5 * H * s];
        let second = [[-along[0], -along[1], 0.0], [along[0], along[1], 0.0]];
        radius(PairKind::EdgeEdge, [[-0.5 * H, 0.0, D], [0.5 * H, 0.0, D], second[0], second[1]])
    };
    assert!((crossed(std::f64::consts::FRAC_PI_2) - H).abs() < 1e-12);
    assert!((crossed(0.5) - H * 0.5f64.sin()).abs() < 1e-12);
    assert!((crossed(0.05) - D).abs() < 1e-12, "nearly parallel");
}
