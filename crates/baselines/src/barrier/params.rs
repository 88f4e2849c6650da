//! Parameters of the log barrier.

use bowknot_errors::{Checks, Errors, ParamError, Parameters};
use bowknot_twoway::CollisionScene;
use bowknot_twoway::geometry::Point;
use serde::{Deserialize, Serialize};

/// Parameters of [`super::Objective`], and of the methods that minimize it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BarrierParams {
    /// The function of the distance, and what chooses its strength. Default Eq. 8.
    pub form: BarrierForm,
    /// Strength k of the barrier of Eq. 8 [kg/s^2]. A larger k makes gaps wider and slows the way to the
    /// target, a smaller one makes gaps tighter and steps shorter. Default 20, the paper's.
    pub strength: f64,
    /// Distance d below which the barrier acts [m]. Default delta; in the paper both are 1 mm. Like delta it
    /// is lowered for neighbors in fine meshes and scaled by the contact distances of the bodies.
    pub range: Option<f64>,
    /// Time step of the inertia term [s] for calls that state none. Default 1/100.
    pub time_step: f64,
    /// Stiffness k_e [kg/s^2] of a penalty 1/2 k_e max(|e| - L, 0)^2 on edges longer than their limit L in a
    /// call. The paper's Eq. 7 has no such term, so that edges stretch. Default 0: no penalty.
    pub edge_stiffness: f64,
    /// The scaling of descent steps. Default blocks.
    pub scaling: Scaling,
    /// The solver of Newton's systems. Default Cholesky, as IPC has it.
    pub linear_solver: LinearSolver,
    /// Both methods stop when their step would move no vertex further than this, in mean edge lengths. Default
    /// 0.01, that of the two-way method.
    pub tolerance: f64,
}

/// The barrier as a function of a pair's distance d.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BarrierForm {
    /// Eq. 8 of the paper with the fixed strength `strength`.
    Paper,
    /// That of Li et al. 2020: a function of the squared distance, which fades between nearly parallel edges,
    /// with a stiffness that adapts. Newton's method alone adapts it.
    Ipc,
}

/// A solver of Newton's systems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LinearSolver {
    /// A sparse factorization.
    Cholesky,
    /// Conjugate gradients to a relative residual of 1e-4: faster, because inertia is a good part of these
    /// systems, and inexact.
    ConjugateGradients,
}

/// The matrix that the gradient is multiplied by in a descent step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scaling {
    /// dt^2/m of each vertex, the inverse of the inertia term: gradient descent in the metric of the
    /// objective (paper, section 3.4), y = x - (x - y0) - dt^2/m dB/dx.
    Mass,
    /// The inverse of each vertex's 3x3 block of a matrix that majorizes the Hessian's convex part.
    Blocks,
}

impl Default for BarrierParams {
    fn default() -> Self {
        Self {
            form: BarrierForm::Paper,
            strength: 20.0,
            range: None,
            time_step: 0.01,
            edge_stiffness: 0.0,
            scaling: Scaling::Blocks,
            linear_solver: LinearSolver::Cholesky,
            tolerance: 0.01,
        }
    }
}

impl Parameters for BarrierParams {
    fn check(&self, checks: &mut Checks) {
        let Self {
            form: _,
            strength,
            range,
            time_step,
            edge_stiffness,
            scaling: _,
            linear_solver: _,
            tolerance,
        } = self;
        checks.positive("strength", *strength);
        if let Some(range) = range {
            checks.positive("range", *range);
        }
        checks.positive("time_step", *time_step);
        checks.non_negative("edge_stiffness", *edge_stiffness);
        checks.positive("tolerance", *tolerance);
    }
}

impl BarrierParams {
    /// Those of IPC (Li et al. 2020), with the same range as other methods.
    pub fn ipc() -> Self {
        Self { form: BarrierForm::Ipc, ..Self::default() }
    }

    /// Those of IPC with the range of its paper: a thousandth of the diagonal of the scene's bounding box.
    pub fn ipc_with_own_range(scene: &CollisionScene) -> Self {
        Self { range: Some(1e-3 * diagonal(scene.rest())), ..Self::ipc() }
    }

    /// Checks every field, and that all pairs within the barrier's range are candidates of the scene.
    ///
    /// # Errors
    /// One error for each field out of its range.
    pub fn validate_for(&self, scene: &CollisionScene) -> Result<(), Errors<ParamError>> {
        let mut checks = Checks::default();
        self.check(&mut checks);
        let largest = scene.lengths().contact_range;
        if let Some(range) = self.range {
            let fits = range <= largest || !range.is_finite();
            let allowed =
                format!("must be at most the contact range of the scene, {largest} m, or pairs are missed");
            checks.require(fits, "range", range, allowed);
        }
        checks.finish()
    }
}

/// Diagonal of the bounding box of `points` [m].
pub(super) fn diagonal(points: &[Point]) -> f64 {
    let Some(first) = points.first() else { return 0.0 };
    let (low, high) = points.iter().fold((*first, *first), |(low, high), p| (low.inf(p), high.sup(p)));
    (high - low).norm()
}
