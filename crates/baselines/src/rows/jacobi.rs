//! Projected Jacobi in place of projected Gauss-Seidel.

use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::lcp::{self, Jacobi, LcpError, LcpInfo, LcpParams, LcpState};
use bowknot_twoway::{RowSolver, RowSystem};

/// Projected Jacobi (paper, section 4.2.2, Fig. 11 and 12).
///
/// The paper damps all rows by one factor, small enough for convergence. Here each row has its own factor,
/// from the number of rows that share its nodes (mass splitting, see [`bowknot_twoway::lcp::Jacobi`]). This
/// converges for any rows without tuning.
#[derive(Clone, Debug)]
pub struct ProjectedJacobi {
    /// Sweeps per backward step. Default 1; up to 800 in Fig. 12.
    pub sweeps: u32,
    /// Factor on each row's step, in (0, 2). Default 1.
    pub relaxation: f64,
    /// Estimate of the iteration's spectral radius for Chebyshev weights within the step (Golub and Varga
    /// 1961), in [0, 1). Default 0: no weights. It has no effect with one sweep per step; for weights between
    /// steps see [`crate::rows::InterStepChebyshev`].
    pub spectral_radius: f64,
    solver: Jacobi,
}

impl Default for ProjectedJacobi {
    fn default() -> Self {
        Self { sweeps: 1, relaxation: 1.0, spectral_radius: 0.0, solver: Jacobi::new() }
    }
}

impl Parameters for ProjectedJacobi {
    fn check(&self, checks: &mut Checks) {
        checks.count_at_least("sweeps", self.sweeps as usize, 1);
        checks.between("relaxation", self.relaxation, 0.0, 2.0);
        let fits = (0.0..1.0).contains(&self.spectral_radius);
        checks.require(fits, "spectral_radius", self.spectral_radius, "must be at least 0 and below 1");
    }
}

impl ProjectedJacobi {
    /// With so many sweeps per step, and Chebyshev weights for `spectral_radius` in [0, 1); 0: no weights.
    pub fn new(sweeps: u32, spectral_radius: f64) -> Self {
        Self { sweeps, spectral_radius, ..Self::default() }
    }

    /// Sweeps over any rows; with a tolerance [unit of the row values] until no row changes by more.
    ///
    /// # Errors
    /// As [`Jacobi::solve`].
    pub fn sweep(
        &mut self,
        system: &lcp::LcpProblem<'_>,
        state: &mut LcpState<'_>,
        tolerance: Option<f64>,
    ) -> Result<LcpInfo, LcpError> {
        let params = LcpParams {
            max_sweeps: self.sweeps,
            tolerance,
            relaxation: self.relaxation,
            spectral_radius: self.spectral_radius,
            ..LcpParams::default()
        };
        self.solver.solve(system, state, &params)
    }
}

impl RowSolver for ProjectedJacobi {
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        self.sweep(&rows.system, state, None).map(|_| ())
    }
}
