use super::*;
use crate::material::SolidModel;
use crate::test_support::{Stream, check_balance, check_derivatives, check_positive};
use nalgebra::Rotation3;

const NONE: Option<Start<'static, 10>> = None;
const MODELS: [SolidModel; 2] = [SolidModel::Stvk, SolidModel::StableNeoHookean];
const CORNERS: [Vector; 4] = [
    Vector::new(0.1, 0.2, 0.3),
    Vector::new(1.2, 0.1, 0.2),
    Vector::new(0.4, 0.9, 0.6),
    Vector::new(0.3, 0.4, 1.3),
];

fn rest() -> [Vector; 10] {
    std::array::from_fn(|a| match a.checked_sub(4) {
        None => CORNERS[a],
        Some(e) => TETRAHEDRON_EDGES[e].iter().map(|&k| CORNERS[k] * 0.5).sum(),
    })
}

fn tet(model: SolidModel, damping: f64) -> QuadraticTetrahedron {
    let material = SolidMaterial { density: 1.0, young_modulus: 100.0, poisson_ratio: 0.3, model, damping };
    let nodes = std::array::from_fn(|a| a as u32);
    QuadraticTetrahedron::new(nodes, &CORNERS, &material).expect("it has a volume")
}

#[test]
fn derivatives_match_differences() {
    let mut stream = Stream::new(1);
    for (scale, amount) in [(1.5, 0.1), (1.0, 0.05), (0.6, 0.05), (-0.5, 0.05)] {
        let x = stream.deformed(&rest(), scale, amount);
        let x0 = stream.deformed(&rest(), 1.0, 0.1);
        for model in MODELS {
            check_derivatives(&tet(model, 0.0), &x, NONE);
            check_derivatives(&tet(model, 0.05), &x, Some(Start { x: &x0, rate: 20.0 }));
        }
    }
}

#[test]
fn filtered_hessians_are_positive_semi_definite() {
    let mut stream = Stream::new(2);
    for (scale, amount) in [(1.5, 0.1), (0.6, 0.1), (-0.5, 0.1), (0.0, 0.0), (1e-200, 0.0)] {
        let x = stream.deformed(&rest(), scale, amount);
        let x0 = stream.deformed(&rest(), 1.0, 0.1);
        for (model, filter) in MODELS.into_iter().zip([Filter::Clamp, Filter::Absolute]) {
            let part = tet(model, 0.02).linearize(&x, Some(Start { x: &x0, rate: 20.0 }), filter);
            check_positive(&part.hessian, "filtered");
            assert!(part.energy.is_finite() && part.gradient.iter().flatten().all(|g| g.is_finite()));
        }
    }
}

#[test]
fn rigid_motions_store_no_energy_and_forces_balance() {
    let mut stream = Stream::new(3);
    let rest = rest();
    for model in MODELS {
        let turn = Rotation3::new(stream.vector() * 3.0);
        let shift = stream.vector() * 100.0;
        let x = rest.map(|x| turn * x + shift);
        let start = Start { x: &rest, rate: 20.0 };
        let part = tet(model, 0.1).linearize(&x, Some(start), Filter::Clamp);
        // Stiffness 135, coordinates near 100: rounding of 1e-14 m.
        assert!(part.energy.abs() < 1e-24, "energy {:e}", part.energy);
        assert!(part.gradient.iter().all(|g| g.norm() < 1e-10), "{:?}", part.gradient);
        let x = stream.deformed(&rest, 0.8, 0.2);
        check_balance(&x, &tet(model, 0.1).linearize(&x, Some(start), Filter::Clamp).gradient);
    }
}

#[test]
fn pure_bending_has_its_energy() {
    // A small deflection u = c (x z, 0, -x^2 / 2) bends without shear: strain e_xx = c z alone, so the energy
    // is the integral of (lambda / 2 + mu) c^2 z^2. The mean of z^2 over a tetrahedron is (sum of z_i^2 +
    // (sum of z_i)^2) / 20.
    let c = 1e-4;
    let rest = rest();
    let x = rest.map(|p| p + Vector::new(p.x * p.z, 0.0, -0.5 * p.x * p.x) * c);
    let (sum, squares) = CORNERS.iter().fold((0.0, 0.0), |(s, q), p| (s + p.z, q + p.z * p.z));
    let volume =
        (CORNERS[1] - CORNERS[0]).cross(&(CORNERS[2] - CORNERS[0])).dot(&(CORNERS[3] - CORNERS[0])) / 6.0;
    for model in MODELS {
        let element = tet(model, 0.0);
        let (lambda, mu) = (100.0 * 0.3 / (1.3 * 0.4), 100.0 / 2.6);
        let expected = (0.5 * lambda + mu) * c * c * volume * (squares + sum * sum) / 20.0;
        let energy = element.energy(&x, NONE);
        assert!((energy / expected - 1.0).abs() < 1e-3, "{model:?}: {energy:e} {expected:e}");
    }
}

#[test]
fn an_affine_map_has_the_energy_of_a_linear_tetrahedron() {
    let mut stream = Stream::new(4);
    for model in MODELS {
        let map = Matrix3::identity() + Matrix3::from_fn(|_, _| 0.3 * stream.next());
        let x = rest().map(|x| map * x);
        let quadratic = tet(model, 0.0);
        let linear = quadratic.quarter.clone().with_share(4.0);
        let expected = linear.energy(&[x[0], x[1], x[2], x[3]], None);
        assert!((quadratic.energy(&x, NONE) - expected).abs() < 1e-12 * expected, "{model:?}");
    }
}
