//! What a solver may be told, and what it tells.

use crate::Error;
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

/// Shape of the region that bounds a friction multiplier by mu times the normal multiplier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrictionBound {
    /// A disc: isotropic friction, the same bound in every tangential direction.
    #[default]
    Disc,
    /// A square along the two tangents: up to sqrt(2) more along its diagonals, but a plain box LCP.
    Square,
}

impl FrictionBound {
    /// The point of the region of `radius` >= 0 that is nearest to `wanted`.
    #[inline(always)]
    pub(crate) fn project(self, wanted: Vector2<f64>, radius: f64) -> Vector2<f64> {
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Params {
    /// Sweeps at most. Default 64. More come nearer to the solution at a cost linear in them.
    pub max_sweeps: u32,
    /// With `Some(t)` a solver stops as soon as a sweep changed no row value by more than t [unit of
    /// the row values], and reaching `max_sweeps` is an error; with `None`, the default, it does
    /// exactly `max_sweeps`. Smaller is more accurate and slower.
    pub tolerance: Option<f64>,
    /// Factor on each row's step, in (0, 2). Default 1: each row is solved exactly. Larger
    /// over-relaxes, smaller damps.
    pub relaxation: f64,
    /// Jacobi only: estimate of the spectral radius of its iteration, in [0, 1), for Chebyshev
    /// acceleration (Golub and Varga 1961). Default 0: none. Nearer to 1 accelerates slow, smooth
    /// errors more; where contacts open and close it may overshoot.
    pub spectral_radius: f64,
    /// Whether rows are taken for equations, s = 0, with multipliers of either sign: a linear system in place of the
    /// complementarity problem, for comparison (Harmon et al. 2008 solve it). Default false. Rows that should
    /// let go then pull; [`crate::residuals`] still judges the complementarity problem.
    pub equations: bool,
    /// Region of the friction multipliers. Default: disc.
    pub friction_bound: FrictionBound,
}

impl Default for Params {
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

impl Params {
    /// Refuses values out of range.
    ///
    /// # Errors
    /// [`Error::Parameter`] for the first.
    pub fn validate(&self) -> Result<(), Error> {
        let check = |name, value: f64, fits: bool, allowed| match fits {
            true => Ok(()),
            false => Err(Error::Parameter { name, value, allowed }),
        };
        if let Some(tolerance) = self.tolerance {
            check("tolerance", tolerance, tolerance >= 0.0, "at least 0")?;
        }
        let (relaxation, radius) = (self.relaxation, self.spectral_radius);
        check("relaxation", relaxation, relaxation > 0.0 && relaxation < 2.0, "between 0 and 2")?;
        check("spectral_radius", radius, (0.0..1.0).contains(&radius), "at least 0 and below 1")
    }
}

/// What an iterative solver did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Info {
    /// Sweeps done.
    pub sweeps: u32,
    /// Largest correction of a row value in the last sweep: |change of the multiplier| times the
    /// row's diagonal [unit of the row values]. It is what the sweep found wrong as it passed, free
    /// of charge; [`crate::residuals`] judges the state that it left.
    pub residual: f64,
}
