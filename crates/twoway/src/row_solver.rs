//! The part of the backward step that solves its rows, as a trait. Other solvers implement it and share
//! everything else.

use crate::coarse::CoarseCorrection;
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_constraints::EdgeLimits;
use bowknot_geometry::Vector;
use bowknot_lcp as lcp;

/// Number of sweeps between two checks of the stretch while polishing.
const POLISH_BATCH: usize = 8;

/// The rows of one backward step, linearized at x^(l), and what belongs to them.
#[derive(Clone, Copy, Debug)]
pub struct RowSystem<'a> {
    /// Inverse weights w, rows and colors. The first rows are contacts; in the linear form of edges, edges
    /// follow.
    pub system: lcp::LcpProblem<'a>,
    /// y', the value of y without multipliers [m].
    pub free: &'a [Vector],
    /// The edges and their limits.
    pub edges: &'a EdgeLimits,
    /// The scene and its parameters.
    pub scene: &'a CollisionScene,
    /// The moving state; its `y` is still y^(l), that of the last step.
    pub state: &'a ResolveState,
}

/// Solves the rows of a backward step, with any accuracy. [`crate::LcpBackward`] rebuilds the rows in each
/// step and keeps their multipliers from one step to the next.
pub trait RowSolver: Send {
    /// Starts a call of the resolver.
    fn begin(&mut self) {}

    /// Improves the multipliers, and y = y' + W J^T lambda with them. On entry this equation holds with the
    /// multipliers of the last step. A solver may return another y; [`crate::Statistics::stationarity_m`] and
    /// the other residuals then count the whole difference of y and y' as forces.
    ///
    /// # Errors
    /// The solver refuses the rows; y' is then used as the target.
    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut lcp::LcpState<'_>) -> Result<(), lcp::LcpError>;
}

/// Projected Gauss-Seidel by colors, with the coarse correction and the polishing that
/// [`crate::BackwardParams`] ask for: the default [`RowSolver`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ColoredSweeps {
    coarse: CoarseCorrection,
}

impl RowSolver for ColoredSweeps {
    fn begin(&mut self) {
        self.coarse.begin();
    }

    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut lcp::LcpState<'_>) -> Result<(), lcp::LcpError> {
        let (system, scene) = (&rows.system, rows.scene);
        let params = &scene.params().solver.backward;
        let one = lcp::LcpParams { max_sweeps: 1, ..lcp::LcpParams::default() };
        let mut batch = |state: &mut lcp::LcpState<'_>, sweeps: usize| -> Result<(), lcp::LcpError> {
            if params.coarse_correction {
                for _ in 0..sweeps {
                    self.coarse.apply(system, rows.free, state);
                    lcp::solve_colored(system, state, &one)?;
                }
            } else {
                let all = lcp::LcpParams { max_sweeps: sweeps as u32, ..one };
                lcp::solve_colored(system, state, &all)?;
            }
            Ok(())
        };
        batch(state, params.sweeps)?;
        if rows.state.remaining < params.polish_distance * scene.lengths().edge {
            let allowed = 1.0 + 0.5 * scene.params().solver.stop.stretch_tolerance;
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
