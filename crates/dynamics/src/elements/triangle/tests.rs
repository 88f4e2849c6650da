use super::*;
use crate::material::ClothMaterial;
use crate::test_support::{Stream, check_derivatives, check_positive, dense};
use nalgebra::Rotation3;

const NONE: Option<Start<'static, 3>> = None;

fn rest() -> [Vector; 3] {
    [Vector::new(0.1, 0.2, 0.3), Vector::new(1.2, 0.1, 0.2), Vector::new(0.4, 0.9, 0.6)]
}

fn triangle(damping: f64) -> Triangle {
    Triangle::new([0, 1, 2], &rest(), (30.0, 50.0), damping).expect("it has an area")
}

fn deformed(stream: &mut Stream, scale: f64, amount: f64) -> [Vector; 3] {
    stream.deformed(&rest(), scale, amount)
}

#[test]
fn elastic_derivatives_match_differences() {
    let mut stream = Stream::new(1);
    // Stretched, near rest, compressed; all states are far from equal and from vanishing singular values.
    for (scale, amount) in [(1.5, 0.2), (1.0, 0.1), (0.7, 0.1)] {
        for _ in 0..20 {
            check_derivatives(&triangle(0.0), &deformed(&mut stream, scale, amount), NONE);
        }
    }
}

#[test]
fn damping_derivatives_match_differences() {
    let mut stream = Stream::new(2);
    for _ in 0..20 {
        let x0 = deformed(&mut stream, 1.0, 0.2);
        let x = x0.map(|x| x + stream.vector() * 0.2);
        check_derivatives(&triangle(0.05), &x, Some(Start { x: &x0, rate: 20.0 }));
    }
}

#[test]
fn filtered_hessians_are_positive_semi_definite() {
    let mut stream = Stream::new(3);
    for filter in [Filter::Clamp, Filter::Absolute] {
        for (scale, amount) in [(1.3, 0.3), (0.5, 0.3), (0.1, 0.05), (0.0, 0.5)] {
            for _ in 0..50 {
                let x0 = deformed(&mut stream, 1.0, 0.2);
                let x = deformed(&mut stream, scale, amount);
                let part = triangle(0.02).linearize(&x, Some(Start { x: &x0, rate: 20.0 }), filter);
                check_positive(&part.hessian, "filtered");
            }
        }
    }
}

#[test]
fn the_clamped_hessian_is_the_nearest_positive_one() {
    // Its eigenvalues over F are those of the exact Hessian with the negative ones set to zero, so the
    // difference is negative semi-definite.
    let mut stream = Stream::new(4);
    for _ in 0..50 {
        let x = deformed(&mut stream, 0.8, 0.15);
        let exact = dense(&triangle(0.0).linearize(&x, NONE, Filter::Exact).hessian);
        let clamped = dense(&triangle(0.0).linearize(&x, NONE, Filter::Clamp).hessian);
        let lowered = (&exact - &clamped).symmetric_eigenvalues().max();
        assert!(lowered < 1e-10 * exact.abs().max(), "clamping lowered a curvature by {lowered:e}");
    }
}

#[test]
fn filters_change_nothing_at_rest_or_under_tension() {
    let mut stream = Stream::new(5);
    let turn = Rotation3::new(Vector::new(0.3, 2.0, -1.0));
    let mut states = vec![rest().map(|x| turn * x)];
    states.extend((0..20).map(|_| deformed(&mut stream, 2.0, 0.1)));
    for x in &states {
        let exact = dense(&triangle(0.0).linearize(x, NONE, Filter::Exact).hessian);
        for filter in [Filter::Clamp, Filter::Absolute] {
            let filtered = dense(&triangle(0.0).linearize(x, NONE, filter).hessian);
            assert!((&exact - &filtered).abs().max() < 1e-12 * exact.abs().max());
        }
    }
}

#[test]
fn rigid_motions_store_no_energy() {
    let mut stream = Stream::new(6);
    for _ in 0..20 {
        let turn = Rotation3::new(stream.vector() * 3.0);
        let shift = stream.vector() * 100.0;
        let x = rest().map(|x| turn * x + shift);
        let part = triangle(0.1).linearize(&x, Some(Start { x: &rest(), rate: 20.0 }), Filter::Clamp);
        // Stiffness 50, coordinates near 100: rounding of 1e-14 m.
        assert!(part.energy < 1e-24, "energy {:e}", part.energy);
        assert!(part.gradient.iter().all(|g| g.norm() < 1e-11), "{:?}", part.gradient);
    }
}

#[test]
fn forces_of_an_element_sum_to_zero_and_have_no_torque() {
    let mut stream = Stream::new(7);
    for _ in 0..50 {
        let x0 = deformed(&mut stream, 1.0, 0.3);
        let x = deformed(&mut stream, 0.8, 0.4);
        let part = triangle(0.1).linearize(&x, Some(Start { x: &x0, rate: 20.0 }), Filter::Clamp);
        let size = part.gradient.iter().map(|g| g.norm()).sum::<f64>() * x[0].norm();
        let force: Vector = part.gradient.iter().sum();
        let torque: Vector = (0..3).map(|k| x[k].cross(&part.gradient[k])).sum();
        assert!(force.norm() < 1e-14 * size && torque.norm() < 1e-13 * size);
    }
}

#[test]
fn uniaxial_tension_has_youngs_modulus() {
    // A strip with free sides that is stretched by e along the first axis narrows by nu e and has a tension
    // of Et e per width.
    let (stiffness, nu) = (1000.0, 0.3);
    let material =
        ClothMaterial { stretch_stiffness: stiffness, poisson_ratio: nu, ..ClothMaterial::default() };
    let corners = [Vector::zeros(), Vector::new(2.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0)];
    let triangle = Triangle::new([0, 1, 2], &corners, material.lame(), 0.0).expect("area");
    let strain = 0.01;
    let x = corners.map(|x| Vector::new(x.x * (1.0 + strain), x.y * (1.0 - nu * strain), 0.0));
    let part = triangle.linearize(&x, NONE, Filter::Clamp);
    assert!((part.energy - 0.5 * stiffness * strain * strain * triangle.area).abs() < 1e-12);
    // There is no force across; half of the tension over the width acts on vertex 1.
    assert!((part.gradient[1] - Vector::new(0.5 * stiffness * strain, 0.0, 0.0)).norm() < 1e-10);
    assert!(part.gradient[2].norm() < 1e-10);
}

#[test]
fn crushed_triangles_give_finite_numbers() {
    let point = [Vector::new(1.0, 2.0, 3.0); 3];
    let line = [Vector::zeros(), Vector::new(1.0, 1.0, 1.0), Vector::new(2.0, 2.0, 2.0)];
    let edge = [Vector::zeros(), Vector::zeros(), Vector::new(0.0, 0.5, 0.0)];
    let tiny = rest().map(|x| x * 1e-200);
    for x in [point, line, edge, tiny] {
        for filter in [Filter::Clamp, Filter::Absolute] {
            let part = triangle(0.1).linearize(&x, Some(Start { x: &rest(), rate: 20.0 }), filter);
            let start = Start { x: &rest(), rate: 20.0 };
            assert!(part.energy.is_finite());
            assert!((part.energy - triangle(0.1).energy(&x, Some(start))).abs() < 1e-12 * part.energy);
            assert!(part.gradient.iter().flat_map(|g| g.iter()).all(|g| g.is_finite()));
            check_positive(&part.hessian, "crushed");
        }
    }
}

#[test]
fn scaling_lengths_scales_energy_by_area_and_forces_by_length() {
    let mut stream = Stream::new(8);
    let x = deformed(&mut stream, 1.1, 0.2);
    let k = 0.01;
    let small = Triangle::new([0, 1, 2], &rest().map(|x| x * k), (30.0, 50.0), 0.0).expect("area");
    let part = triangle(0.0).linearize(&x, NONE, Filter::Clamp);
    let scaled = small.linearize(&x.map(|x| x * k), NONE, Filter::Clamp);
    assert!((scaled.energy - k * k * part.energy).abs() < 1e-12 * part.energy);
    for a in 0..3 {
        assert!((scaled.gradient[a] - part.gradient[a] * k).norm() < 1e-12 * part.gradient[a].norm());
        assert!(
            (scaled.hessian[a][a] - part.hessian[a][a]).abs().max() < 1e-12 * part.hessian[a][a].abs().max()
        );
    }
}

/// Gradient, blocks of the Hessian and energy.
fn numbers(part: &Linearization<3>) -> Vec<f64> {
    let hessian = part.hessian.iter().enumerate().flat_map(|(a, row)| row[a..].iter().flatten());
    part.gradient.iter().flatten().chain(hessian).chain([&part.energy]).copied().collect()
}

/// With and without damping, stretched, compressed and crushed to a line or a point: in each place of a batch the
/// same bits, and those of one alone but for rounding.
#[test]
fn several_at_once_are_as_one_by_one() {
    let mut stream = Stream::new(9);
    for (scale, amount) in [(1.3, 0.3), (1.0, 0.01), (0.5, 0.3), (0.1, 0.05), (0.0, 0.0)] {
        for (filter, rate) in [(Filter::Clamp, 20.0), (Filter::Absolute, 20.0), (Filter::Clamp, 0.0)] {
            let triangles: [Triangle; BATCH] =
                std::array::from_fn(|k| triangle(if k % 3 == 0 { 0.0 } else { 0.02 }));
            let x0: [[Vector; 3]; BATCH] = std::array::from_fn(|_| deformed(&mut stream, 1.0, 0.2));
            let mut x: [[Vector; 3]; BATCH] = std::array::from_fn(|_| deformed(&mut stream, scale, amount));
            x[5] = [Vector::zeros(), Vector::x() * 0.1, Vector::x() * 0.2];
            let in_order = |order: [usize; BATCH]| {
                let mut found = vec![Vec::new(); BATCH];
                let (elements, x, x0) =
                    (order.map(|k| &triangles[k]), order.map(|k| x[k]), order.map(|k| x0[k]));
                Triangle::linearize_batch(elements, &x, &x0, rate, filter, &mut |k, part| {
                    found[order[k]] = numbers(part);
                });
                found
            };
            let together = in_order(std::array::from_fn(|k| k));
            assert_eq!(together, in_order(std::array::from_fn(|k| (k + 3) % BATCH)));
            for k in 0..BATCH {
                let start = (rate > 0.0).then_some(Start { x: &x0[k], rate });
                let alone = numbers(&triangles[k].linearize(&x[k], start, filter));
                let largest = alone.iter().fold(0.0f64, |most, number| most.max(number.abs()));
                let apart = alone.iter().zip(&together[k]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(apart <= 1e-11 * largest, "{scale} {filter:?} {k}: {apart:e} of {largest:e}");
            }
        }
    }
}
