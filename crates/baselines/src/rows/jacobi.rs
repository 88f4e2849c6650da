//! Projected Jacobi in place of projected Gauss-Seidel.

use bowknot_twoway::lcp::{self, Jacobi, LcpError, LcpInfo, LcpParams, LcpState};
use bowknot_twoway::{RowSolver, RowSystem};

/// Projected Jacobi (paper, section 4.2.2, Fig. 11 and 12).
///
/// The paper damps all rows by one factor until it converges. Here each row has its own, from the number of rows that share
/// its nodes (mass splitting, see [`bowknot_twoway::lcp::Jacobi`]): it converges for any rows without tuning, and no slower.
#[derive(Clone, Debug)]
pub struct ProjectedJacobi {
    /// Sweeps a backward step. Default 1; Fig. 12 takes 800.
    pub sweeps: u32,
    /// Factor on each row's step, in (0, 2). Default 1.
    pub relaxation: f64,
    /// Estimate of the iteration's spectral radius for Chebyshev weights within the step (Golub and Varga 1961), in [0, 1);
    /// 0, the default, for none. With one sweep a step it does nothing: see [`crate::rows::InterStepChebyshev`].
    pub spectral_radius: f64,
    solver: Jacobi,
}

impl Default for ProjectedJacobi {
    fn default() -> Self {
        Self { sweeps: 1, relaxation: 1.0, spectral_radius: 0.0, solver: Jacobi::new() }
    }
}

impl ProjectedJacobi {
    /// So many sweeps a step, with Chebyshev weights for `spectral_radius` in [0, 1), 0 for none.
    pub fn new(sweeps: u32, spectral_radius: f64) -> Self {
        Self { sweeps, spectral_radius, ..Self::default() }
    }

    /// Sweeps over rows, whoever made them; with a tolerance [unit of the row values] until none is changed by more.
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
