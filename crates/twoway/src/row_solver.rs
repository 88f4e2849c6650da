//! The part of the backward step that solves its rows, as a trait. Other solvers implement it and share
//! everything else.

use crate::coarse::CoarseCorrection;
use crate::live::LiveRows;
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

    /// Whether the solver implements [`Self::solve_live`], which then replaces [`Self::solve`] where edges
    /// have the ball form. Default false.
    fn keeps_to_live_edges(&self) -> bool {
        false
    }

    /// Improves the multipliers as [`Self::solve`] does, of the contact rows and of those edges only that act
    /// or could come to act. The cost of a step is then that of what acts.
    ///
    /// # Errors
    /// As [`Self::solve`].
    fn solve_live(&mut self, _rows: &mut LiveRows<'_>) -> Result<(), lcp::LcpError> {
        Ok(())
    }
}

/// Projected Gauss-Seidel by colors, with the coarse correction and the polishing that
/// [`crate::BackwardParams`] ask for: the default [`RowSolver`].
#[derive(Debug, Default)]
pub struct ColoredSweeps {
    solver: lcp::GaussSeidel,
    coarse: CoarseCorrection,
}

impl RowSolver for ColoredSweeps {
    fn begin(&mut self) {
        self.coarse.begin();
    }

    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut lcp::LcpState<'_>) -> Result<(), lcp::LcpError> {
        let Self { solver, coarse } = self;
        coarse.begin_step();
        let corrects = rows.scene.params().solver.backward.coarse_correction;
        let batch = |state: &mut lcp::LcpState<'_>, sweeps: usize| {
            (0..sweeps).try_for_each(|_| {
                if corrects {
                    coarse.apply(&rows.system, rows.free, None, state);
                }
                solver.sweep(&rows.system, state, &lcp::LcpParams::default())
            })
        };
        sweep_and_polish(rows.scene, rows.state, state, batch, |state| stretch(rows.edges, state.y))
    }

    fn keeps_to_live_edges(&self) -> bool {
        true
    }

    fn solve_live(&mut self, rows: &mut LiveRows<'_>) -> Result<(), lcp::LcpError> {
        let Self { solver, coarse } = self;
        coarse.begin_step();
        let (scene, state) = (rows.scene, rows.state);
        let corrects = scene.params().solver.backward.coarse_correction;
        let batch = |rows: &mut LiveRows<'_>, sweeps: usize| {
            rows.sweep(sweeps, |live, state| {
                if corrects {
                    coarse.apply(&live.system, live.free, Some(live.touched), state);
                }
                solver.sweep(&live.system, state, &lcp::LcpParams::default())
            })
        };
        sweep_and_polish(scene, state, rows, batch, |rows| rows.stretch())
    }
}

/// Makes the sweeps that the parameters ask for by calls of `batch`, and more of them while x is near to y
/// and the edges at y are too long.
fn sweep_and_polish<R>(
    scene: &CollisionScene,
    state: &ResolveState,
    rows: &mut R,
    mut batch: impl FnMut(&mut R, usize) -> Result<(), lcp::LcpError>,
    stretch: impl Fn(&R) -> f64,
) -> Result<(), lcp::LcpError> {
    let params = &scene.params().solver.backward;
    let mut sweeps = params.sweeps_of(state.call.has_unknown());
    batch(rows, sweeps)?;
    if state.remaining < params.polish_distance * scene.lengths().edge {
        let allowed = 1.0 + 0.5 * scene.params().solver.stop.stretch_tolerance;
        while sweeps < params.polish_sweeps && stretch(rows) > allowed {
            let more = POLISH_BATCH.min(params.polish_sweeps - sweeps);
            batch(rows, more)?;
            sweeps += more;
        }
    }
    Ok(())
}

fn stretch(edges: &EdgeLimits, y: &[Vector]) -> f64 {
    edges
        .balls
        .iter()
        .map(|ball| (y[ball.vertices[0] as usize] - y[ball.vertices[1] as usize]).norm() / ball.limit)
        .fold(0.0, f64::max)
}
