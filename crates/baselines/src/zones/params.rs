//! Parameters of impact-zone optimization.

use bowknot_errors::{Checks, Parameters};
use serde::{Deserialize, Serialize};

/// Parameters of [`super::ImpactZones`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ZoneParams {
    /// Largest number of rounds of detection and optimization. Default 100.
    pub max_iterations: usize,
    /// The solver of the rows of zones. Default Gauss-Seidel.
    pub solver: ZoneSolver,
    /// What the rows ask for. Default the contact distance.
    pub goal: ZoneGoal,
    /// Largest number of sweeps, gradient steps or iterations of conjugate gradients of one optimization.
    /// Default 200.
    pub max_sweeps: u32,
    /// Gauss-Seidel stops when a sweep changes no row by more than this, and conjugate gradients when no row is
    /// off by more, in mean edge lengths. Default 0.01.
    pub tolerance: f64,
    /// A pair that does not meet, but ends at less than this share of its contact distance, gets a row too.
    /// Default 0, as published: zones prevent intersections and keep no distance. With 0.8 they solve the
    /// problem of the methods that keep a distance, up to a fifth of it. Closer to 1, rows that are
    /// linearized again and again may oscillate.
    pub thickness: f64,
}

/// Solvers of the rows of impacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ZoneSolver {
    /// Projected Gauss-Seidel, which fails least of the three.
    GaussSeidel,
    /// The linear system of all rows as equations, as in Harmon et al. 2008: a pair that has met once sticks
    /// for the rest of the call. Conjugate gradients solve it for zero velocities, Gauss-Seidel for
    /// distances.
    LinearSystem,
    /// The augmented Lagrangian of Tang et al. 2018.
    AugmentedLagrangian,
}

/// What the row of an impact asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ZoneGoal {
    /// That the pair ends at its contact distance.
    Distance,
    /// That the points that meet do not approach during the call: their relative velocity along the normal of
    /// the impact is 0, as in Harmon et al. 2008.
    ZeroVelocity,
}

impl Default for ZoneParams {
    fn default() -> Self {
        Self {
            max_iterations: 100,
            solver: ZoneSolver::GaussSeidel,
            goal: ZoneGoal::Distance,
            max_sweeps: 200,
            tolerance: 0.01,
            thickness: 0.0,
        }
    }
}

impl Parameters for ZoneParams {
    fn check(&self, checks: &mut Checks) {
        let Self { max_iterations, solver: _, goal: _, max_sweeps, tolerance, thickness } = self;
        checks.count_at_least("max_iterations", *max_iterations, 1);
        checks.count_at_least("max_sweeps", *max_sweeps as usize, 1);
        checks.positive("tolerance", *tolerance);
        let fits = (0.0..=1.0).contains(thickness);
        checks.require(fits, "thickness", thickness, "must be at least 0 and at most 1");
    }
}
