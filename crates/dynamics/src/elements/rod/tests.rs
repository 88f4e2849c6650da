use super::*;
use crate::test_support::{Stream, check_balance, check_gradient, check_positive, dense};
use bowknot_geometry::Point;
use nalgebra::Rotation3;

const NONE: Option<Start<'static, 5>> = None;
const NODES: [u32; 5] = [0, 1, 2, 3, 4];

fn material(rest_shape: RestShape, bend_damping: f64) -> StrandMaterial {
    StrandMaterial {
        bend_stiffness: 3.0,
        twist_stiffness: 2.0,
        bend_damping,
        rest_shape,
        ..StrandMaterial::hair()
    }
}

/// Two edges that meet at an angle, with frame points in their places.
fn rest() -> [Vector; 5] {
    let mut x = vec![Point::new(0.1, 0.2, 0.0), Point::new(1.0, 0.3, 0.1), Point::new(1.6, 1.2, 0.4)];
    bowknot_geometry::add_frame_points(&mut x, &[[0, 1], [1, 2]]);
    std::array::from_fn(|k| x[k].coords)
}

fn turn(rest_shape: RestShape, damping: f64) -> RodTurn {
    RodTurn::new(NODES, &rest(), &material(rest_shape, damping), 1.0).expect("edges have lengths")
}

#[test]
fn gradients_match_differences() {
    let mut stream = Stream::new(1);
    for amount in [0.01, 0.1, 0.3] {
        let x = stream.deformed(&rest(), 1.0, amount);
        let x0 = stream.deformed(&rest(), 1.1, 0.1);
        for rest_shape in [RestShape::Flat, RestShape::Initial] {
            check_gradient(&turn(rest_shape, 0.0), &x, NONE);
            check_gradient(&turn(rest_shape, 0.05), &x, Some(Start { x: &x0, rate: 20.0 }));
        }
    }
}

#[test]
fn the_hessian_is_exact_at_rest_and_never_negative() {
    let turn = turn(RestShape::Initial, 0.0);
    let hessian = dense(&turn.linearize(&rest(), NONE, Filter::Exact).hessian);
    let h = 1e-6;
    for k in 0..15 {
        let moved = |by: f64| {
            let mut x = rest();
            x[k / 3][k % 3] += by;
            turn.gradient(&x, NONE)
        };
        let (up, down) = (moved(h), moved(-h));
        for i in 0..15 {
            let difference = (up[i / 3][i % 3] - down[i / 3][i % 3]) / (2.0 * h);
            assert!((hessian[(i, k)] - difference).abs() < 1e-6 * hessian.amax(), "{i} {k}");
        }
    }
    let mut stream = Stream::new(2);
    for amount in [0.0, 0.3, 2.0] {
        let x = stream.deformed(&rest(), 1.0, amount);
        let part = turn.linearize(&x, NONE, Filter::Clamp);
        check_positive(&part.hessian, "rod");
    }
}

#[test]
fn rigid_motions_store_no_energy_and_forces_balance() {
    let mut stream = Stream::new(3);
    let turn = turn(RestShape::Initial, 0.1);
    let spin = Rotation3::new(stream.vector() * 3.0);
    let moved = rest().map(|x| spin * x + Vector::new(1.0, 2.0, 3.0));
    let start = rest();
    // Dissipation does not see the rotation either.
    assert!(turn.energy(&moved, Some(Start { x: &start, rate: 100.0 })).abs() < 1e-25);
    let x = stream.deformed(&rest(), 1.0, 0.3);
    check_balance(&x, &turn.gradient(&x, NONE));
}

#[test]
fn bending_and_twist_have_the_energy_of_theory() {
    // Straight edges of lengths 1 and 2, frame points up; EI = 3, GJ = 2, M = 1.5.
    let straight = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.5, 0.0, 0.5], [2.0, 0.0, 1.0]];
    let straight: [Vector; 5] = straight.map(Vector::from);
    let turn = RodTurn::new(NODES, &straight, &material(RestShape::Initial, 0.0), 1.0).expect("lengths");
    assert_eq!(turn.energy(&straight, NONE), 0.0);
    for angle in [-1.2, 0.4, 2.9_f64] {
        let mut x = straight;
        x[4] = Vector::new(2.0, -angle.sin(), angle.cos());
        let energy = turn.energy(&x, NONE);
        assert!((energy - 2.0 / 3.0 * angle * angle).abs() < 1e-14, "{angle} {energy}");
        // In any plane, bent by the angle: curvature 2 tan(angle/2).
        for axis in [Vector::y(), Vector::z()] {
            let spin = Rotation3::new(axis * angle);
            let bent = |p: Vector| x[1] + spin * (p - x[1]);
            let mut x = straight;
            (x[2], x[4]) = (bent(x[2]), bent(x[4]));
            let expected = (2.0 * (0.5 * angle).tan()).powi(2);
            let energy = turn.energy(&x, NONE);
            assert!((energy - expected).abs() < 1e-12 * expected, "{angle} {energy} {expected}");
        }
    }
}

#[test]
fn degenerate_states_have_finite_forces() {
    for rest_shape in [RestShape::Flat, RestShape::Initial] {
        let turn = turn(rest_shape, 0.1);
        let [a, b, c, p, q] = rest();
        // Folded back, an edge of no length, a frame point on the line of its edge.
        for x in [[a, b, a, p, q], [a, a, c, p, q], [a, b, c, a, q], [a; 5]] {
            let part = turn.linearize(&x, Some(Start { x: &rest(), rate: 10.0 }), Filter::Clamp);
            let finite = |v: &Vector| v.iter().all(|c| c.is_finite());
            assert!(part.energy.is_finite() && part.gradient.iter().all(finite));
            assert!(dense(&part.hessian).iter().all(|h| h.is_finite()));
        }
    }
}
