use super::*;
use crate::elements::triangle::Triangle;
use crate::test_support::{Stream, check_balance, check_derivatives, check_positive, dense};
use nalgebra::Rotation3;

const REST: [Vector; 3] =
    [Vector::new(0.1, 0.2, 0.3), Vector::new(1.2, 0.1, 0.2), Vector::new(0.4, 0.9, 0.6)];
const WARP: Vector = Vector::new(1.0, 0.4, 0.2);
const WEAVE: Weave = Weave { c11: 130.0, c12: 20.0, c22: 60.0, shear: 8.0 };

fn triangle(damping: f64) -> WovenTriangle {
    WovenTriangle::new([0, 1, 2], &REST, &WARP, WEAVE, damping).expect("it has an area")
}

#[test]
fn derivatives_match_differences() {
    let mut stream = Stream::new(1);
    for (scale, amount) in [(1.5, 0.2), (1.0, 0.1), (0.7, 0.1)] {
        for _ in 0..20 {
            let x = stream.deformed(&REST, scale, amount);
            let x0 = stream.deformed(&REST, 1.0, 0.2);
            check_derivatives(&triangle(0.0), &x, None);
            check_derivatives(&triangle(0.05), &x, Some(Start { x: &x0, rate: 20.0 }));
        }
    }
}

#[test]
fn with_equal_stiffnesses_it_equals_the_isotropic_triangle() {
    let material = ClothMaterial { stretch_stiffness: 100.0, poisson_ratio: 0.3, ..ClothMaterial::cotton() };
    let isotropic = Triangle::new([0, 1, 2], &REST, material.lame(), 0.03).expect("area");
    let woven = WovenTriangle::new([0, 1, 2], &REST, &WARP, Weave::new(&material), 0.03).expect("area");
    let mut stream = Stream::new(2);
    for scale in [0.5, 1.0, 1.5] {
        let (x, x0) = (stream.deformed(&REST, scale, 0.2), stream.deformed(&REST, 1.0, 0.2));
        let start = Some(Start { x: &x0, rate: 20.0 });
        for filter in [Filter::Exact, Filter::Clamp, Filter::Absolute] {
            let (a, b) = (isotropic.linearize(&x, start, filter), woven.linearize(&x, start, filter));
            assert!((a.energy - b.energy).abs() < 1e-11 * a.energy);
            (0..3).for_each(|k| assert!((a.gradient[k] - b.gradient[k]).norm() < 1e-10));
            assert!((dense(&a.hessian) - dense(&b.hessian)).abs().max() < 1e-9, "{filter:?}");
        }
    }
}

#[test]
fn filtered_hessians_are_positive_also_of_crushed_triangles() {
    let mut stream = Stream::new(3);
    let mut states: Vec<[Vector; 3]> =
        (0..80).map(|k| stream.deformed(&REST, 0.02 * f64::from(k), 0.2)).collect();
    states.push([Vector::new(1.0, 2.0, 3.0); 3]);
    states.push([0.0, 1.0, 2.0].map(|t| Vector::new(t, t, t)));
    for x in &states {
        for filter in [Filter::Clamp, Filter::Absolute] {
            let start = Start { x: &REST, rate: 20.0 };
            let part = triangle(0.02).linearize(x, Some(start), filter);
            check_positive(&part.hessian, "woven");
            assert!(part.gradient.iter().flat_map(|g| g.iter()).all(|g| g.is_finite()));
        }
    }
}

#[test]
fn rigid_motions_store_no_energy_and_forces_balance() {
    let mut stream = Stream::new(4);
    for _ in 0..20 {
        let turn = Rotation3::new(stream.vector() * 3.0);
        let shift = stream.vector() * 100.0;
        let x = REST.map(|x| turn * x + shift);
        let start = Start { x: &REST, rate: 20.0 };
        let part = triangle(0.1).linearize(&x, Some(start), Filter::Clamp);
        assert!(part.energy < 1e-23 && part.gradient.iter().all(|g| g.norm() < 1e-10), "{:e}", part.energy);
        let x = stream.deformed(&REST, 0.8, 0.4);
        check_balance(&x, &triangle(0.1).linearize(&x, Some(start), Filter::Clamp).gradient);
    }
}

#[test]
fn warp_weft_and_shear_have_their_stiffnesses() {
    let material = ClothMaterial {
        stretch_stiffness: 1000.0,
        weft_stiffness: Some(400.0),
        shear_stiffness: Some(30.0),
        poisson_ratio: 0.3,
        ..ClothMaterial::cotton()
    };
    let corners = [Vector::zeros(), Vector::new(2.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0)];
    // The projection of the warp into the plane counts.
    let woven =
        WovenTriangle::new([0, 1, 2], &corners, &Vector::new(3.0, 0.0, 5.0), Weave::new(&material), 0.0)
            .expect("area");
    let force = |f: Matrix2<f64>| {
        let x = corners.map(|x| {
            let y = f * x.xy();
            Vector::new(y.x, y.y, 0.0)
        });
        woven.linearize(&x, None, Filter::Clamp)
    };
    // Along warp the strip narrows by nu_12 = nu sqrt(E1/E2), along weft by nu sqrt(E2/E1).
    let (e, ratio) = (0.01, (1000.0f64 / 400.0).sqrt());
    let along = force(Matrix2::new(1.0 + e, 0.0, 0.0, 1.0 - 0.3 / ratio * e));
    assert!((along.gradient[1] - Vector::new(0.5 * 1000.0 * e, 0.0, 0.0)).norm() > 1e-3);
    let along = force(Matrix2::new(1.0 + e, 0.0, 0.0, 1.0 - 0.3 * ratio * e));
    assert!((along.gradient[1] - Vector::new(0.5 * 1000.0 * e, 0.0, 0.0)).norm() < 1e-10);
    assert!(along.gradient[2].norm() < 1e-10);
    let across = force(Matrix2::new(1.0 - 0.3 / ratio * e, 0.0, 0.0, 1.0 + e));
    assert!((across.gradient[2] - Vector::new(0.0, 400.0 * e, 0.0)).norm() < 1e-10);
    assert!(across.gradient[1].norm() < 1e-10);
    // Pure shear e12: stress 2 G e12.
    let shear = force(Matrix2::new(1.0, e, e, 1.0));
    assert!((shear.gradient[2] - Vector::new(2.0 * 30.0 * e, 0.0, 0.0)).norm() < 1e-10);
    assert!(WovenTriangle::new([0, 1, 2], &corners, &Vector::z(), Weave::new(&material), 0.0).is_none());
}
