//! Parameters of the iterative solvers.

use crate::vector::TangentVector;
use bowknot_errors::{Checks, Parameters};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Shape of the region that bounds a friction multiplier by mu times the normal multiplier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum FrictionBound {
    /// A disc: isotropic friction, the same bound in every tangential direction.
    #[default]
    Disc,
    /// A square along the two tangents: the problem is a box LCP; the bound is up to sqrt(2) larger along the
    /// diagonals.
    Square,
}

impl FrictionBound {
    /// The point of the region of `radius` >= 0 that is nearest to `wanted`.
    #[inline(always)]
    pub(crate) fn project(self, wanted: TangentVector, radius: f64) -> TangentVector {
        match self {
            FrictionBound::Disc => {
                let norm = wanted.norm();
                if norm > radius { wanted * (radius / norm) } else { wanted }
            }
            FrictionBound::Square => wanted.map(|c| c.max(-radius).min(radius)),
        }
    }
}

/// Parameters of the iterative solvers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct LcpParams {
    /// Largest number of sweeps. Default 64. More sweeps are more accurate; the cost is linear in them.
    pub max_sweeps: u32,
    /// With `Some(t)` a solver stops after the first sweep that changes no row value by more than t [unit of
    /// the row values], and it is an error to reach `max_sweeps`. With `None`, the default, it does exactly
    /// `max_sweeps`. Smaller is more accurate and slower.
    pub tolerance: Option<f64>,
    /// Factor on each row's step, in (0, 2). Default 1: each row is solved exactly. Above 1 over-relaxes,
    /// below 1 damps.
    pub relaxation: f64,
    /// Jacobi only: estimate of the spectral radius of its iteration, in [0, 1), for Chebyshev acceleration
    /// (Golub and Varga 1961). Default 0: none. A value nearer to 1 reduces slow, smooth errors faster, but
    /// may overshoot where contacts open and close.
    pub spectral_radius: f64,
    /// Whether rows are equations, s = 0, with multipliers of either sign: a linear system in place of the
    /// complementarity problem, for comparison (Harmon et al. 2008 solve it). Default false. Rows that should
    /// separate then pull. [`crate::residuals`] evaluates the complementarity problem all the same.
    pub equations: bool,
    /// Region of the friction multipliers. Default: disc.
    pub friction_bound: FrictionBound,
}

impl Default for LcpParams {
    fn default() -> Self {
        Self {
            max_sweeps: 64,
            tolerance: None,
            relaxation: 1.0,
            spectral_radius: 0.0,
            equations: false,
            friction_bound: FrictionBound::Disc,
        }
    }
}

impl Parameters for LcpParams {
    fn check(&self, checks: &mut Checks) {
        let Self { max_sweeps: _, tolerance, relaxation, spectral_radius, equations: _, friction_bound: _ } =
            *self;
        if let Some(tolerance) = tolerance {
            checks.require(tolerance >= 0.0, "tolerance", tolerance, "must be at least 0");
        }
        checks.between("relaxation", relaxation, 0.0, 2.0);
        let fits = (0.0..1.0).contains(&spectral_radius);
        checks.require(fits, "spectral_radius", spectral_radius, "must be at least 0 and below 1");
    }
}
