//! Momenta, and keyframes.

use super::*;
use nalgebra::Rotation3;

fn body() -> Vec<Point> {
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.9, 0.1], [0.5, -0.3, 0.7]].map(Point::from).to_vec()
}

fn momenta(vertices: &[(Point, Vector, f64)]) -> (Vector, Vector) {
    let linear = vertices.iter().fold(Vector::zeros(), |sum, (_, d, m)| sum + d * *m);
    let angular = vertices.iter().fold(Vector::zeros(), |sum, (x, d, m)| sum + x.coords.cross(d) * *m);
    (linear, angular)
}

#[test]
fn a_free_zone_keeps_both_momenta_and_turns_like_a_rigid_body() {
    let wanted: Vec<(Point, Vector, f64)> = body()
        .into_iter()
        .zip([[0.1, 0.0, 0.3], [-0.2, 0.1, 0.0], [0.0, 0.0, -0.4], [0.1, 0.2, 0.1]])
        .zip([1.0, 2.0, 0.5, 1.5])
        .map(|((x, d), m)| (x, Vector::from(d), m))
        .collect();
    let motion = Motion::keeping_momentum(&wanted);
    let moved: Vec<_> = wanted.iter().map(|(x, _, m)| (*x, motion.displacement(x), *m)).collect();
    let ((p, l), (p_after, l_after)) = (momenta(&wanted), momenta(&moved));
    assert!((p - p_after).norm() < 1e-14 && (l - l_after).norm() < 1e-14);
    // Velocities of a rigid body change no distance at first order.
    for (a, da, _) in &moved {
        for (b, db, _) in &moved {
            assert!((a - b).dot(&(da - db)).abs() < 1e-14);
        }
    }
}

#[test]
fn two_vertices_on_a_line_keep_their_momenta_too() {
    let wanted = [
        (Point::origin(), Vector::new(0.0, 0.0, 1.0), 1.0),
        (Point::new(1.0, 0.0, 0.0), Vector::new(0.5, 0.0, -1.0), 3.0),
    ];
    let motion = Motion::keeping_momentum(&wanted);
    let moved = wanted.map(|(x, _, m)| (x, motion.displacement(&x), m));
    let ((p, l), (p_after, l_after)) = (momenta(&wanted), momenta(&moved));
    assert!((p - p_after).norm() < 1e-14 && (l - l_after).norm() < 1e-14, "{l:?} {l_after:?}");
}

#[test]
fn keyframes_that_are_rigid_are_followed_and_others_are_not() {
    let rotation = Rotation3::from_axis_angle(&Vector::z_axis(), 1.2);
    let frame = |x: &Point| rotation * x + Vector::new(0.3, -2.0, 0.0);
    let mut vertices: Vec<_> = body().into_iter().map(|x| (x, frame(&x) - x, 1.0)).collect();
    let motion = Motion::following(&vertices).unwrap();
    let elsewhere = Point::new(3.0, 1.0, -2.0);
    assert!((motion.displacement(&elsewhere) - (frame(&elsewhere) - elsewhere)).norm() < 1e-12);
    // One that moves on its own.
    vertices[2].1 += Vector::new(0.0, 0.0, 1e-3);
    assert_eq!(Motion::following(&vertices), None);
    // At rest; and one vertex alone, which is taken along.
    vertices.iter_mut().for_each(|v| v.1 = Vector::zeros());
    assert_eq!(Motion::following(&vertices), Some(Motion::Rest));
    let alone = Motion::following(&[(elsewhere, Vector::x(), 1.0)]).unwrap();
    assert!((alone.displacement(&Point::origin()) - Vector::x()).norm() < 1e-15);
    // Half a turn has no straight path without a collapse.
    let half = Rotation3::from_axis_angle(&Vector::z_axis(), std::f64::consts::PI);
    let turned: Vec<_> = body().into_iter().map(|x| (x, half * x - x, 1.0)).collect();
    assert_eq!(Motion::following(&turned), None);
}
