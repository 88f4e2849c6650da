use super::*;
use crate::material::SolidModel;
use crate::test_support::{Stream, check_balance, check_derivatives, check_positive, dense};
use nalgebra::Rotation3;

const NONE: Option<Start<'static, 4>> = None;
const MODELS: [SolidModel; 2] = [SolidModel::Stvk, SolidModel::StableNeoHookean];
const REST: [Vector; 4] = [
    Vector::new(0.1, 0.2, 0.3),
    Vector::new(1.2, 0.1, 0.2),
    Vector::new(0.4, 0.9, 0.6),
    Vector::new(0.3, 0.4, 1.3),
];
/// Unit legs along the axes: F is the edge matrix.
const UNIT: [Vector; 4] =
    [Vector::new(0., 0., 0.), Vector::new(1., 0., 0.), Vector::new(0., 1., 0.), Vector::new(0., 0., 1.)];

fn material(model: SolidModel, damping: f64) -> SolidMaterial {
    SolidMaterial { density: 1.0, young_modulus: 100.0, poisson_ratio: 0.3, model, damping }
}

fn tet(model: SolidModel, damping: f64) -> Tetrahedron {
    Tetrahedron::new([0, 1, 2, 3], &REST, &material(model, damping)).expect("it has a volume")
}

fn unit(model: SolidModel) -> Tetrahedron {
    Tetrahedron::new([0, 1, 2, 3], &UNIT, &material(model, 0.0)).expect("it has a volume")
}

/// First Piola-Kirchhoff stress [Pa] at deformation gradient `f`.
fn stress(model: SolidModel, f: &Matrix3<f64>) -> Matrix3<f64> {
    let tet = unit(model);
    let part = tet.linearize(&UNIT.map(|x| f * x), NONE, Filter::Exact);
    Matrix3::from_columns(&[part.gradient[1], part.gradient[2], part.gradient[3]]) / tet.volume
}

/// Stretched, near rest, compressed, and inverted.
fn states(stream: &mut Stream) -> Vec<[Vector; 4]> {
    let mut states = Vec::new();
    for (scale, amount) in [(1.5, 0.2), (1.0, 0.1), (0.6, 0.1), (-1.0, 0.1), (-0.5, 0.1)] {
        states.extend((0..10).map(|_| stream.deformed(&REST, scale, amount)));
    }
    states
}

#[test]
fn elastic_derivatives_match_differences() {
    let mut stream = Stream::new(1);
    for x in states(&mut stream) {
        MODELS.iter().for_each(|model| check_derivatives(&tet(*model, 0.0), &x, NONE));
    }
}

#[test]
fn damping_derivatives_match_differences() {
    let mut stream = Stream::new(2);
    for x in states(&mut stream) {
        let x0 = stream.deformed(&REST, 1.0, 0.2);
        for model in MODELS {
            check_derivatives(&tet(model, 0.05), &x, Some(Start { x: &x0, rate: 20.0 }));
        }
    }
}

#[test]
fn filtered_hessians_are_positive_semi_definite() {
    let mut stream = Stream::new(3);
    let mut all = states(&mut stream);
    all.push([Vector::new(1.0, 2.0, 3.0); 4]);
    all.push([0.0, 1.0, 2.0, 3.0].map(|t| Vector::new(t, t, -t)));
    all.push(REST.map(|x| Vector::new(x.x, x.y, 0.0)));
    all.push(REST.map(|x| x * 1e-200));
    for x in &all {
        let x0 = stream.deformed(&REST, 1.0, 0.2);
        for (model, filter) in MODELS
            .into_iter()
            .zip([Filter::Clamp, Filter::Absolute])
            .chain([(SolidModel::Stvk, Filter::Absolute), (SolidModel::StableNeoHookean, Filter::Clamp)])
        {
            for damping in [0.0, 0.02] {
                let start = Start { x: &x0, rate: 20.0 };
                let part = tet(model, damping).linearize(x, Some(start), filter);
                check_positive(&part.hessian, "filtered");
                assert!(part.energy.is_finite() && part.gradient.iter().flatten().all(|g| g.is_finite()));
            }
        }
    }
}

#[test]
fn the_clamped_hessian_is_the_nearest_positive_one() {
    let mut stream = Stream::new(4);
    for model in MODELS {
        for _ in 0..30 {
            let x = stream.deformed(&REST, 0.6, 0.15);
            let exact = dense(&tet(model, 0.0).linearize(&x, NONE, Filter::Exact).hessian);
            let clamped = dense(&tet(model, 0.0).linearize(&x, NONE, Filter::Clamp).hessian);
            let lowered = (&exact - &clamped).symmetric_eigenvalues().max();
            assert!(lowered < 1e-10 * exact.abs().max(), "clamping lowered a curvature by {lowered:e}");
        }
    }
}

#[test]
fn rigid_motions_store_no_energy_and_forces_balance() {
    let mut stream = Stream::new(5);
    for model in MODELS {
        for _ in 0..20 {
            let turn = Rotation3::new(stream.vector() * 3.0);
            let shift = stream.vector() * 100.0;
            let x = REST.map(|x| turn * x + shift);
            let start = Start { x: &REST, rate: 20.0 };
            let part = tet(model, 0.1).linearize(&x, Some(start), Filter::Clamp);
            // Stiffness 135, coordinates near 100: rounding of 1e-14 m.
            assert!(part.energy.abs() < 1e-24, "energy {:e}", part.energy);
            assert!(part.gradient.iter().all(|g| g.norm() < 1e-10), "{:?}", part.gradient);

            let x = stream.deformed(&REST, 0.8, 0.4);
            check_balance(&x, &tet(model, 0.1).linearize(&x, Some(start), Filter::Clamp).gradient);
        }
    }
}

#[test]
fn the_hessian_at_rest_is_that_of_linear_elasticity() {
    // stress = lambda tr(e) I + 2 mu e for a small strain in any direction: exact moduli.
    let (lambda, mu) = material(SolidModel::Stvk, 0.0).lame();
    let mut stream = Stream::new(6);
    for model in MODELS {
        for _ in 0..10 {
            let strain = Matrix3::from_fn(|_, _| stream.next());
            let strain = (strain + strain.transpose()) * 0.5;
            let h = 1e-5;
            let slope = (stress(model, &(Matrix3::identity() + strain * h))
                - stress(model, &(Matrix3::identity() - strain * h)))
                / (2.0 * h);
            let expected = Matrix3::identity() * (lambda * strain.trace()) + strain * (2.0 * mu);
            assert!((slope - expected).abs().max() < 1e-6 * mu, "{slope} {expected}");
        }
    }
}

#[test]
fn the_stress_of_uniform_strain_is_that_of_the_laws() {
    // Patch tests at finite strain, with the stresses of the papers.
    let (lambda, mu) = material(SolidModel::Stvk, 0.0).lame();
    let mut stream = Stream::new(7);
    for _ in 0..20 {
        let f = Matrix3::identity() + Matrix3::from_fn(|_, _| 0.4 * stream.next());
        let strain = (f.transpose() * f - Matrix3::identity()) * 0.5;
        let expected = f * (strain * (2.0 * mu) + Matrix3::identity() * (lambda * strain.trace()));
        let error = (stress(SolidModel::Stvk, &f) - expected).abs().max();
        assert!(error < 1e-12 * expected.abs().max().max(mu), "{error:e}");

        let (l, m) = (lambda + 5.0 / 6.0 * mu, 4.0 / 3.0 * mu);
        let cofactor = f.try_inverse().expect("regular").transpose() * f.determinant();
        let alpha = 1.0 + m / l - m / (4.0 * l);
        let expected =
            f * (m * (1.0 - 1.0 / (f.norm_squared() + 1.0))) + cofactor * (l * (f.determinant() - alpha));
        let error = (stress(SolidModel::StableNeoHookean, &f) - expected).abs().max();
        assert!(error < 1e-12 * expected.abs().max().max(mu), "{error:e}");
    }
}

#[test]
fn stvk_softens_under_compression_and_stable_neo_hookean_does_not() {
    // Uniaxial strain: the stress of StVK, (lambda + 2 mu) (s^3 - s)/2, is strongest at s = 1/sqrt 3 and zero
    // at s = 0. That of stable neo-Hookean grows down to inversion.
    let pull = |model, s: f64| stress(model, &Matrix3::from_diagonal(&Vector::new(s, 1.0, 1.0)))[(0, 0)];
    let (lambda, mu) = material(SolidModel::Stvk, 0.0).lame();
    let strongest = 1.0 / 3.0f64.sqrt();
    let expected = -(lambda + 2.0 * mu) * strongest / 3.0;
    assert!((pull(SolidModel::Stvk, strongest) - expected).abs() < 1e-12 * mu);
    assert!(pull(SolidModel::Stvk, strongest) < pull(SolidModel::Stvk, strongest + 0.01));
    assert!(pull(SolidModel::Stvk, strongest) < pull(SolidModel::Stvk, strongest - 0.01));
    assert!(pull(SolidModel::Stvk, 0.0).abs() < 1e-12 * mu);
    let pushes: Vec<f64> =
        (0..=12).map(|k| pull(SolidModel::StableNeoHookean, 1.0 - 0.1 * f64::from(k))).collect();
    assert!(pushes.windows(2).all(|p| p[1] < p[0]), "{pushes:?}");
}

#[test]
fn energies_of_small_strains_are_accurate() {
    // The energy of a strain of 1e-9 is 1/2 e:C:e. The formula of stable neo-Hookean as published has no
    // correct digit there.
    let (lambda, mu) = material(SolidModel::Stvk, 0.0).lame();
    for model in MODELS {
        let e = 2f64.powi(-30);
        let x = UNIT.map(|x| Vector::new(x.x * (1.0 + e), x.y, x.z));
        let expected = (0.5 * lambda + mu) * e * e / 6.0;
        let energy = unit(model).energy(&x, NONE);
        assert!((energy - expected).abs() < 1e-6 * expected, "{model:?}: {energy:e} {expected:e}");
    }
}
