//! The part of the backward step that solves its rows, as a trait: other methods plug in here and share everything else.

use crate::coarse::CoarseCorrection;
use crate::{Problem, State};
use bowknot_constraints::EdgeLimits;
use bowknot_geometry::Vector;
use bowknot_lcp as lcp;

/// Sweeps between two looks at the stretch while polishing.
const POLISH_BATCH: usize = 8;

/// The rows of one backward step, linearised at x^(l), and what belongs to them.
#[derive(Clone, Copy, Debug)]
pub struct RowSystem<'a> {
    /// Inverse weights w, rows and colours. The first rows are contacts, in the linear form of edges the others edges.
    pub system: lcp::LcpProblem<'a>,
    /// y', where y is without any multiplier [m].
    pub free: &'a [Vector],
    /// The edges and their limits.
    pub edges: &'a EdgeLimits,
    /// The scene and its parameters.
    pub problem: &'a Problem,
    /// The moving state; its `y` is still that of the last step, y^(l).
    pub state: &'a State,
}

/// Solves the rows of a backward step, as exactly as it likes: [`crate::LcpBackward`] builds them anew in each step and
/// keeps their multipliers from one to the next.
pub trait RowSolver: Send {
    /// Starts a call of the resolver.
    fn begin(&mut self) {}

    /// Improves the multipliers, and y = y' + W J^T lambda with them: on entry that holds with the multipliers kept from
    /// the last step. A solver that leaves another y is free to do so; [`crate::Statistics::stationarity_m`] and the
    /// like then count as forces whatever has moved y away from y'.
    ///
    /// # Errors
    /// A refusal of the rows; y' is then used for a target.
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut lcp::LcpState<'_>) -> Result<(), lcp::LcpError>;
}

/// Projected Gauss-Seidel by colours, with the coarse correction and the polishing that
/// [`crate::BackwardParams`] ask for: the default [`RowSolver`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ColouredSweeps {
    coarse: CoarseCorrection,
}

impl RowSolver for ColouredSweeps {
    fn begin(&mut self) {
        self.coarse.begin();
    }

    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut lcp::LcpState<'_>) -> Result<(), lcp::LcpError> {
        let (system, problem) = (&rows.system, rows.problem);
        let params = &problem.params.backward;
        let one = lcp::LcpParams { max_sweeps: 1, ..lcp::LcpParams::default() };
        let mut batch = |state: &mut lcp::LcpState<'_>, sweeps: usize| -> Result<(), lcp::LcpError> {
            if params.coarse_correction {
                for _ in 0..sweeps {
                    self.coarse.apply(system, rows.free, state);
                    lcp::solve_coloured(system, state, &one)?;
                }
            } else {
                let all = lcp::LcpParams { max_sweeps: sweeps as u32, ..one };
                lcp::solve_coloured(system, state, &all)?;
            }
            Ok(())
        };
        batch(state, params.sweeps)?;
        if rows.state.remaining < params.polish_distance * problem.lengths.edge {
            let allowed = 1.0 + 0.5 * problem.params.stop.stretch_tolerance;
            let mut sweeps = params.sweeps;
            while sweeps < params.polish_sweeps && stretch(rows.edges, state.y) > allowed {
                let more = POLISH_BATCH.min(params.polish_sweeps - sweeps);
                batch(state, more)?;
                sweeps += more;
            }
        }
        Ok(())
    }
}

fn stretch(edges: &EdgeLimits, y: &[Vector]) -> f64 {
    edges
        .balls
        .iter()
        .map(|ball| (y[ball.vertices[0] as usize] - y[ball.vertices[1] as usize]).norm() / ball.limit)
        .fold(0.0, f64::max)
}
