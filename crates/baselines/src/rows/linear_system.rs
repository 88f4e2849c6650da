//! The linear system of Harmon et al. 2008 in place of the complementarity problem.

use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::lcp::{self, LcpError, LcpParams, LcpState, Row, solve_colored};
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

/// Solves the rows as equations by conjugate gradients, until none is off by more than `tolerance` [m] or
/// after `max_iterations`, and moves y accordingly. Rows may repeat each other; where they contradict each
/// other, the result is what the iterations came to.
pub(crate) fn solve_equations(
    system: &lcp::LcpProblem<'_>,
    state: &mut LcpState<'_>,
    tolerance: f64,
    max_iterations: u32,
) {
    let (rows, weights) = (system.rows().rows, system.weights());
    let movable = |row: &Row| row.inverse_diagonal > 0.0;
    let mut residual: Vec<f64> =
        rows.iter().map(|row| if movable(row) { -row.value(state.y) } else { 0.0 }).collect();
    let precondition =
        |r: &[f64]| -> Vec<f64> { r.iter().zip(rows).map(|(r, row)| r * row.inverse_diagonal).collect() };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut scaled = precondition(&residual);
    let mut direction = scaled.clone();
    let mut square = dot(&residual, &scaled);
    let mut motion = vec![Vector::zeros(); weights.len()];
    for _ in 0..max_iterations {
        if residual.iter().all(|r| r.abs() <= tolerance) {
            break;
        }
        motion.fill(Vector::zeros());
        for (row, d) in rows.iter().zip(&direction) {
            for (&v, g) in row.vertices.iter().zip(&row.gradients) {
                motion[v as usize] += weights[v as usize] * *d * g;
            }
        }
        let change = |row: &Row| -> f64 {
            if !movable(row) {
                return 0.0;
            }
            row.vertices.iter().zip(&row.gradients).map(|(&v, g)| g.dot(&motion[v as usize])).sum()
        };
        let product: Vec<f64> = rows.iter().map(change).collect();
        let curvature = dot(&direction, &product);
        if curvature.is_nan() || curvature <= 0.0 {
            break;
        }
        let step = square / curvature;
        state.lambda.iter_mut().zip(&direction).for_each(|(lambda, d)| *lambda += step * d);
        state.y.iter_mut().zip(&motion).for_each(|(y, d)| *y += step * d);
        residual.iter_mut().zip(&product).for_each(|(r, p)| *r -= step * p);
        scaled = precondition(&residual);
        let next = dot(&residual, &scaled);
        let share = next / square;
        square = next;
        direction.iter_mut().zip(&scaled).for_each(|(d, z)| *d = z + share * *d);
    }
}

impl RowSolver for LinearSystem {
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        self.sweep(&rows.system, state)
    }
}
