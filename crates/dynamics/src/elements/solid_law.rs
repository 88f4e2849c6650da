//! Isotropic laws of solids as functions of the signed singular values of F.
//!
//! An isotropic energy density W(s1, s2, s3) with p_i = dW/ds_i has a Hessian over F that is known in the
//! frames of the singular vectors (Smith, de Goes and Kim 2019, "Analytic Eigensystems for Isotropic
//! Distortion Energies"):
//!
//! | mode | eigenmatrix | curvature |
//! |---|---|---|
//! | scaling | span of the u_i v_i^T | d2W / ds_i ds_j |
//! | flip | (u_i v_j^T + u_j v_i^T) / sqrt 2 | (p_i - p_j) / (s_i - s_j) |
//! | twist | (u_i v_j^T - u_j v_i^T) / sqrt 2 | (p_i + p_j) / (s_i + s_j) |
//!
//! For both laws below the quotients are polynomials, so that nothing is divided by a difference or a small
//! number.

use crate::linear::assembly::SolidKind;
use crate::material::solid::SolidModel;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// A law with its constants [Pa].
#[derive(Clone, Copy, Debug)]
pub(crate) enum SolidLaw {
    /// W = mu |E|^2 + lambda/2 tr(E)^2, E = (F^T F - I)/2.
    Stvk { lambda: f64, mu: f64 },
    /// W = mu/2 (I - 3) - mu/2 log((I + 1)/4) + lambda/2 (J - 1)^2 - 3/4 mu (J - 1), I = |F|^2, J = det F:
    /// Smith, de Goes and Kim 2018, "Stable Neo-Hookean Flesh Simulation", eq. 14, less its value at rest.
    /// The constants are theirs (section 3.4), from those of linear elasticity: mu = 4/3 mu_lin, lambda =
    /// lambda_lin + 5/6 mu_lin.
    StableNeoHookean { lambda: f64, mu: f64 },
}

/// Principal stresses and curvatures. The entry k of `flip` and `twist` belongs to the pair (i, j) of the two
/// other indices.
pub(crate) struct Principal {
    pub stress: Vector,
    pub scaling: Matrix3<f64>,
    pub flip: Vector,
    pub twist: Vector,
}

impl SolidLaw {
    /// The law with the Lame parameters of linear elasticity [Pa].
    pub fn new(model: SolidModel, (lambda, mu): (f64, f64)) -> Self {
        match model {
            SolidModel::Stvk => Self::Stvk { lambda, mu },
            SolidModel::StableNeoHookean => {
                Self::StableNeoHookean { lambda: lambda + 5.0 / 6.0 * mu, mu: 4.0 / 3.0 * mu }
            }
        }
    }

    /// Energy density [J/m^3]. It is accurate near rest: the rounding error is strain times stiffness times
    /// an ulp.
    #[inline]
    pub fn density(&self, f: &Matrix3<f64>) -> f64 {
        let strain = green_strain(f);
        let trace = strain.trace();
        match *self {
            Self::Stvk { lambda, mu } => mu * strain.norm_squared() + 0.5 * lambda * trace * trace,
            Self::StableNeoHookean { lambda, mu } => {
                let j = f.determinant();
                // I - 3 = 2 tr E. The terms of mu/2 (2 tr E - log(1 + tr E / 2)) - 3/4 mu (J - 1) cancel to
                // first order. 3/8 mu ((I - 3) - 2 (J - 1)) is therefore computed from J^2 - 1 = 2 tr E + 4
                // E_2 + 8 det E.
                let (grow, first_order) = if j > 0.5 {
                    let second = 0.5 * (trace * trace - strain.norm_squared());
                    let third = strain.determinant();
                    let grow = (2.0 * trace + 4.0 * second + 8.0 * third) / (j + 1.0);
                    (grow, (2.0 * trace * grow - 8.0 * second - 16.0 * third) / (j + 1.0))
                } else {
                    (j - 1.0, 2.0 * trace - 2.0 * (j - 1.0))
                };
                let half = 0.5 * trace;
                0.375 * mu * first_order + 0.5 * mu * (half - libm::log1p(half)) + 0.5 * lambda * grow * grow
            }
        }
    }

    /// The law and its constants lambda and mu [Pa].
    pub fn describe(&self) -> (SolidKind, [f64; 2]) {
        match *self {
            Self::Stvk { lambda, mu } => (SolidKind::Stvk, [lambda, mu]),
            Self::StableNeoHookean { lambda, mu } => (SolidKind::StableNeoHookean, [lambda, mu]),
        }
    }

    /// First Piola-Kirchhoff stress dW/dF [Pa]: F (2 mu E + lambda tr(E) I), or eq. 18 of Smith et al. 2018,
    /// mu (1 - 1/(I + 1)) F + (lambda (J - 1) - 3/4 mu) dJ/dF.
    #[inline]
    pub fn stress(&self, f: &Matrix3<f64>) -> Matrix3<f64> {
        let strain = green_strain(f);
        match *self {
            Self::Stvk { lambda, mu } => {
                f * (strain * (2.0 * mu) + Matrix3::from_diagonal_element(lambda * strain.trace()))
            }
            Self::StableNeoHookean { lambda, mu } => {
                let (a, b, c) = (f.column(0), f.column(1), f.column(2));
                let cofactor = Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)]);
                let invariant = f.norm_squared() + 1.0;
                f * (mu * (1.0 - 1.0 / invariant)) + cofactor * (lambda * (f.determinant() - 1.0) - 0.75 * mu)
            }
        }
    }

    /// Stresses and unfiltered curvatures [Pa] at singular values `s`.
    #[inline]
    pub fn principal(&self, s: &Vector) -> Principal {
        let others = |k: usize| (s[(k + 1) % 3], s[(k + 2) % 3]);
        match *self {
            Self::Stvk { lambda, mu } => {
                let strain = s.map(|s| 0.5 * (s - 1.0) * (s + 1.0));
                let pressure = lambda * strain.sum();
                let mut scaling = s * s.transpose() * lambda;
                (0..3).for_each(|i| scaling[(i, i)] += mu * (3.0 * s[i] * s[i] - 1.0) + pressure);
                let quotient = |k: usize, sign: f64| {
                    let (a, b) = others(k);
                    mu * (a * a + sign * a * b + b * b - 1.0) + pressure
                };
                Principal {
                    stress: s.zip_map(&strain, |s, e| s * (2.0 * mu * e + pressure)),
                    scaling,
                    flip: Vector::from_fn(|k, _| quotient(k, 1.0)),
                    twist: Vector::from_fn(|k, _| quotient(k, -1.0)),
                }
            }
            Self::StableNeoHookean { lambda, mu } => {
                let invariant = s.norm_squared() + 1.0;
                let shear = mu * (1.0 - 1.0 / invariant);
                // Cofactors: dJ/ds_k.
                let cofactor = Vector::from_fn(|k, _| others(k).0 * others(k).1);
                let pressure = lambda * (s[0] * s[1] * s[2] - 1.0) - 0.75 * mu;
                let mut scaling = s * s.transpose() * (2.0 * mu / (invariant * invariant))
                    + cofactor * cofactor.transpose() * lambda;
                for i in 0..3 {
                    scaling[(i, i)] += shear;
                    for j in (0..3).filter(|&j| j != i) {
                        scaling[(i, j)] += pressure * s[3 - i - j];
                    }
                }
                Principal {
                    stress: s * shear + cofactor * pressure,
                    scaling,
                    flip: s.map(|s| shear - pressure * s),
                    twist: s.map(|s| shear + pressure * s),
                }
            }
        }
    }
}

/// (F^T F - I) / 2.
#[inline]
pub(crate) fn green_strain(f: &Matrix3<f64>) -> Matrix3<f64> {
    (f.tr_mul(f) - Matrix3::identity()) * 0.5
}
