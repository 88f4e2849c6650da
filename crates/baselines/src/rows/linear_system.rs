//! The linear system of Harmon et al. 2008 in place of the complementarity problem.

use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::lcp::{self, LcpError, LcpParams, LcpState, solve_colored};
use bowknot_twoway::{RowSolver, RowSystem};

/// Gauss-Seidel on A lambda + q = 0 with all rows as equations (Harmon et al. 2008, "Robust treatment of
/// simultaneous collisions"; paper, section 4.3.1, Fig. 13). Nothing can separate: contacts stick, and linear
/// edge rows keep their lengths at the limit (Fig. 14), so that the paper leaves edges out
/// (`constraints.edges = false`). Distance limits, which have no linear form, keep their projection.
///
/// As in the paper, only the linear system of 2008 is compared, not the whole method, which works on
/// velocities. With `backward.active_rows` the system has only active rows, which is close to the collisions
/// of Harmon et al.; without it, every pair in range has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinearSystem {
    /// Sweeps per backward step. Default 20, the paper's.
    pub sweeps: u32,
    /// Whether every update is followed by lambda <- max(lambda, 0), the one line of Fig. 13. That makes it
    /// projected Gauss-Seidel with so many sweeps. Default false.
    pub projected: bool,
}

impl Default for LinearSystem {
    fn default() -> Self {
        Self { sweeps: 20, projected: false }
    }
}

impl Parameters for LinearSystem {
    fn check(&self, checks: &mut Checks) {
        checks.count_at_least("sweeps", self.sweeps as usize, 1);
    }
}

impl LinearSystem {
    /// The linear system with the one-line projection, and defaults elsewhere.
    pub fn projected() -> Self {
        Self { projected: true, ..Self::default() }
    }

    /// Sweeps over any rows.
    ///
    /// # Errors
    /// As [`lcp::solve_colored`].
    pub fn sweep(&self, system: &lcp::LcpProblem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        let params =
            LcpParams { max_sweeps: self.sweeps, equations: !self.projected, ..LcpParams::default() };
        solve_colored(system, state, &params).map(|_| ())
    }
}

impl RowSolver for LinearSystem {
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        self.sweep(&rows.system, state)
    }
}
