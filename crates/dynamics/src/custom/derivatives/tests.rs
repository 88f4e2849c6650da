use super::*;
use crate::custom::element::ElementMatrix;

/// A spring of stiffness 3 N/m and rest length 1 m, with a factor by which each quantity is wrong.
#[derive(Debug)]
struct Spring {
    vertices: [u32; 2],
    factors: [f64; 3],
    is_invariant: bool,
    is_positive: bool,
}

impl Spring {
    fn with(factors: [f64; 3]) -> Self {
        Self { vertices: [4, 7], factors, is_invariant: true, is_positive: false }
    }
}

impl CustomElement for Spring {
    fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    fn energy(&self, x: &[Point]) -> f64 {
        1.5 * ((x[1] - x[0]).norm() - 1.0).powi(2) * self.factors[0]
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        let way = x[1] - x[0];
        gradient[1] = way.normalize() * 3.0 * (way.norm() - 1.0);
        gradient[0] = -gradient[1];
        gradient[1].y *= self.factors[1];
    }

    fn hessian(&self, x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let (length, n) = ((x[1] - x[0]).norm(), (x[1] - x[0]).normalize());
        let along = n * n.transpose();
        let mut block = (along + (Matrix3::identity() - along) * (1.0 - 1.0 / length)) * 3.0;
        hessian.add(0, 0, &block);
        hessian.add(1, 1, &block);
        block[(2, 0)] *= self.factors[2];
        hessian.add(0, 1, &-block);
    }

    fn is_invariant(&self) -> bool {
        self.is_invariant
    }

    fn is_positive_semidefinite(&self) -> bool {
        self.is_positive
    }
}

const X: [Point; 2] = [Point::new(0.3, -0.2, 0.1), Point::new(0.6, 0.5, 0.7)];

#[test]
fn right_derivatives_are_within_rounding_of_differences() {
    let errors = check_derivatives(&Spring::with([1.0; 3]), &X).expect("right");
    assert!(errors.gradient < 1e-9 && errors.hessian < 1e-9, "{errors:?}");
    assert!(errors.asymmetry == 0.0 && errors.rigid_motion < 1e-14, "{errors:?}");
    assert!(errors.smallest_eigenvalue < -0.01, "a spring that is pressed gives way aside: {errors:?}");
    // At rest there is no force to compare with, and far away differences are less accurate.
    let rest = [X[0], X[0] + (X[1] - X[0]).normalize()];
    check_derivatives(&Spring::with([1.0; 3]), &rest).expect("right");
    let far = X.map(|x| x + Vector::new(300.0, -200.0, 100.0));
    check_derivatives(&Spring::with([1.0; 3]), &far).expect("right");
}

#[test]
fn mistakes_are_named() {
    let problem = |spring: Spring| check_derivatives(&spring, &X).expect_err("wrong");
    let wrong = problem(Spring::with([1.0, 1.001, 1.0]));
    assert!(matches!(wrong, DerivativeProblem::Gradient { vertex: 1, axis: 1, .. }), "{wrong}");
    assert!(wrong.to_string().starts_with("the gradient by y of vertex 1 is "), "{wrong}");
    let wrong = problem(Spring::with([1.0, 1.0, 1.001]));
    let DerivativeProblem::Hessian { vertices, axes, given, expected } = wrong else { panic!("{wrong}") };
    assert!([([0, 1], [2, 0]), ([1, 0], [0, 2])].contains(&(vertices, axes)));
    assert!((given / expected - 1.001).abs() < 1e-6);
    assert!(matches!(
        problem(Spring::with([f64::NAN, 1.0, 1.0])),
        DerivativeProblem::NonFinite { quantity: "energy" }
    ));
    assert!(matches!(
        problem(Spring::with([1.0, f64::INFINITY, 1.0])),
        DerivativeProblem::NonFinite { quantity: "gradient" }
    ));
    assert_eq!(problem(Spring::with([1.0, 1.0, f64::NAN])).to_string(), "the Hessian is not finite");
    let claims = Spring { is_positive: true, ..Spring::with([1.0; 3]) };
    assert!(matches!(problem(claims), DerivativeProblem::Indefinite { .. }));
    let given = check_derivatives(&Spring::with([1.0; 3]), &X[..1]).expect_err("one position");
    assert_eq!(given, DerivativeProblem::Count { given: 1, vertices: 2 });
}

/// The energy of a height, which is that of translations aside alone.
#[derive(Debug)]
struct Height([u32; 1]);

impl CustomElement for Height {
    fn vertices(&self) -> &[u32] {
        &self.0
    }

    fn energy(&self, x: &[Point]) -> f64 {
        2.0 * x[0].z
    }

    fn gradient(&self, _x: &[Point], gradient: &mut [Vector]) {
        gradient[0].z = 2.0;
    }

    fn hessian(&self, _x: &[Point], _hessian: &mut ElementMatrix<'_>) {}

    fn is_invariant(&self) -> bool {
        true
    }
}

#[test]
fn an_energy_that_depends_on_the_place_is_not_invariant() {
    let problem = check_derivatives(&Height([0]), &X[..1]).expect_err("not invariant");
    assert!(matches!(problem, DerivativeProblem::NotInvariant { change } if change > 0.1), "{problem}");
}

/// An energy without derivatives.
#[derive(Debug)]
struct Forgotten([u32; 1]);

impl CustomElement for Forgotten {
    fn vertices(&self) -> &[u32] {
        &self.0
    }

    fn energy(&self, x: &[Point]) -> f64 {
        x[0].y
    }

    fn gradient(&self, _x: &[Point], _gradient: &mut [Vector]) {}

    fn hessian(&self, _x: &[Point], _hessian: &mut ElementMatrix<'_>) {}
}

#[test]
fn a_gradient_that_was_forgotten_is_found() {
    let problem = check_derivatives(&Forgotten([0]), &X[..1]).expect_err("forgotten");
    assert!(matches!(problem, DerivativeProblem::Gradient { vertex: 0, axis: 1, .. }), "{problem}");
}

/// An energy whose Hessian lacks a mirrored entry.
#[derive(Debug)]
struct Lopsided([u32; 1]);

impl CustomElement for Lopsided {
    fn vertices(&self) -> &[u32] {
        &self.0
    }

    fn energy(&self, x: &[Point]) -> f64 {
        x[0].coords.norm_squared()
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        gradient[0] = x[0].coords * 2.0;
    }

    fn hessian(&self, _x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let mut block = Matrix3::from_diagonal_element(2.0);
        block[(0, 2)] = 1e-6;
        hessian.add(0, 0, &block);
    }
}

#[test]
fn asymmetry_is_measured() {
    let errors = check_derivatives(&Lopsided([3]), &X[..1]).expect("small");
    assert!((errors.asymmetry - 5e-7).abs() < 1e-9, "{errors:?}");
}
