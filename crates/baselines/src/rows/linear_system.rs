//! The linear system of Harmon et al. 2008 in place of the complementarity problem.

use bowknot_twoway::lcp::{self, LcpError, LcpParams, LcpState, solve_coloured};
use bowknot_twoway::{RowSolver, RowSystem};

/// Gauss-Seidel on A lambda + q = 0, all rows taken for equations (Harmon et al. 2008, "Robust treatment of simultaneous
/// collisions"; paper, section 4.3.1, Fig. 13). What should let go is held: contacts stick, and linear edge rows keep
/// their lengths at the limit (Fig. 14), so that the paper leaves edges out (`constraints.edges = false`). Ball rows, which
/// have no linear form, keep their projection.
///
/// As in the paper this is not the whole method of 2008, which works on velocities: the system alone is compared.
/// It holds the rows that it is given: with `backward.active_rows` those that press or are about to, near to the
/// collisions that Harmon et al. take; without, every pair in range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinearSystem {
    /// Sweeps a backward step. Default 20, the paper's.
    pub sweeps: u32,
    /// Whether every update is followed by lambda <- max(lambda, 0), the one line of Fig. 13. That makes it projected
    /// Gauss-Seidel with so many sweeps. Default false.
    pub projected: bool,
}

impl Default for LinearSystem {
    fn default() -> Self {
        Self { sweeps: 20, projected: false }
    }
}

impl LinearSystem {
    /// The same with the one-line projection.
    pub fn projected() -> Self {
        Self { projected: true, ..Self::default() }
    }

    /// Sweeps over rows, whoever made them.
    ///
    /// # Errors
    /// As [`lcp::solve_coloured`].
    pub fn sweep(&self, system: &lcp::LcpProblem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        let params =
            LcpParams { max_sweeps: self.sweeps, equations: !self.projected, ..LcpParams::default() };
        solve_coloured(system, state, &params).map(|_| ())
    }
}

impl RowSolver for LinearSystem {
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        self.sweep(&rows.system, state)
    }
}
