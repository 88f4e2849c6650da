//! Newton's method with its vectors on a device: what a backend gets and does.
//!
//! The host decides (springs, line searches, when to end), the backend computes. Between
//! [`NewtonBackend::begin_target`] and [`NewtonBackend::target`] no vector over all nodes crosses to the
//! other side: the host sees sums, and positions of the nodes that springs act on.
//!
//! With d = x - x0 the displacement since the start of the time step, the potential of the bodies is
//!
//! ```text
//! P(x) = 1/2 d.(R + K) d + c.d + sum of elements e(x; x0)
//! ```
//!
//! | term | is |
//! |---|---|
//! | R | one 3 x 3 block per node: inertia, drag of mass and air; [`NewtonStep::row_sums`] |
//! | K | flat bending and its damping over dt, a multiple of the identity per pair of nodes, whose rows sum to zero; [`NewtonStep::bending`], [`NewtonStep::scalars`] |
//! | c | the gradient of these terms at the start; [`NewtonStep::gradient`] |
//! | e | membranes, curved bends, tetrahedra, with their damping; [`ElementModel`] |
//!
//! so its gradient is (R + K) d + c + sum of e', and its change from x to x + u is u.((R + K)(d + u/2) + c)
//! plus the changes of the elements: nothing cancels that is larger than the change itself.

use crate::device_work::DeviceWork;
use crate::linear::accuracy::CgInfo;
use crate::linear::assembly::{AssemblySprings, ElementModel};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use std::error::Error;
use std::fmt::Debug;

/// Why a backend failed.
pub type NewtonBackendError = Box<dyn Error + Send + Sync>;

/// Newton iterations in single precision.
///
/// Norms of residuals are those of the backend's preconditioner M, an approximation of H^-1: the squared norm
/// of r is r.M r. All numbers are SI; vectors have one entry per node. After an error the host computes the
/// rest of the time step itself.
pub trait NewtonBackend: Debug + Send {
    /// What it is called where runs are described.
    fn name(&self) -> String;

    /// What its device was asked for since it was opened.
    fn work(&self) -> DeviceWork {
        DeviceWork::default()
    }

    /// Takes over what is fixed during a run.
    ///
    /// # Errors
    /// What the backend fails of, such as a lack of memory.
    fn set_model(&mut self, model: &ElementModel) -> Result<(), NewtonBackendError>;

    /// Begins a time step. There is no last target.
    ///
    /// # Errors
    /// What the backend fails of.
    fn begin_step(&mut self, step: &NewtonStep<'_>) -> Result<(), NewtonBackendError>;

    /// Begins a target: sets the iterate, the free nodes, the nodes to [watch](Watched), and how far the
    /// others are from where they must end. Returns where the watched nodes are at the iterate, as the
    /// backend rounds positions.
    ///
    /// # Errors
    /// What the backend fails of.
    fn begin_target(&mut self, target: &NewtonTarget<'_>) -> Result<Watched, NewtonBackendError>;

    /// Computes gradient and matrix of the bodies at the iterate. `absolute` says whether negative curvatures
    /// change their sign; otherwise they are set to zero.
    ///
    /// # Errors
    /// What the backend fails of.
    fn linearize(&mut self, absolute: bool) -> Result<(), NewtonBackendError>;

    /// Sets `blocks` to the diagonal blocks of the matrix of the bodies at the watched nodes [N/m].
    ///
    /// # Errors
    /// What the backend fails of.
    fn diagonal(&mut self, blocks: &mut Vec<Matrix3<f64>>) -> Result<(), NewtonBackendError>;

    /// Solves H p = b over the free nodes, with springs added to gradient and matrix, and b = -(g + H q) with
    /// the gradient g and the displacements q of the other nodes to their ends. The start is the combination,
    /// with the least energy, of the ways from the iterate to [`NewtonStep::inertial`] and, if there is one,
    /// to the last target.
    ///
    /// # Errors
    /// What the backend fails of.
    fn solve(
        &mut self,
        springs: &AssemblySprings<'_>,
        limits: &SolveLimits,
    ) -> Result<NewtonSolve, NewtonBackendError>;

    /// Sets `sums` to the sum of b - R p over each of [`ElementModel::components`], without the elements and
    /// K, whose share is zero [N].
    ///
    /// # Errors
    /// What the backend fails of.
    fn component_residuals(&mut self, sums: &mut Vec<Vector>) -> Result<(), NewtonBackendError>;

    /// Adds a translation to the step p of the nodes of each component, one entry per component [m].
    ///
    /// # Errors
    /// What the backend fails of.
    fn translate(&mut self, translations: &[Vector]) -> Result<(), NewtonBackendError>;

    /// Sets the trial to the iterate plus `length` times the step p, with nodes that are not free at their
    /// ends. With a length of 0 the trial becomes the reference that the changes of energy count from, until
    /// the next such call.
    ///
    /// # Errors
    /// What the backend fails of.
    fn place(&mut self, length: f64) -> Result<Trial, NewtonBackendError>;

    /// Begins a search along the step p: the reference as by [`Self::place`] with a length of 0, then the
    /// trial at full length. Returns the watched nodes at the reference, and the trial.
    ///
    /// # Errors
    /// What the backend fails of.
    fn begin_search(&mut self) -> Result<(Watched, Trial), NewtonBackendError>;

    /// Makes the trial the iterate. Nodes that are not free are at their ends there.
    ///
    /// # Errors
    /// What the backend fails of.
    fn start_from_trial(&mut self) -> Result<(), NewtonBackendError>;

    /// Keeps a copy of the trial.
    ///
    /// # Errors
    /// What the backend fails of.
    fn keep_trial(&mut self) -> Result<(), NewtonBackendError>;

    /// Makes the kept trial the trial and the iterate, as [`Self::start_from_trial`] does.
    ///
    /// # Errors
    /// What the backend fails of.
    fn start_from_kept_trial(&mut self) -> Result<(), NewtonBackendError>;

    /// Sets `y` to the trial [m] and makes it the last target.
    ///
    /// # Errors
    /// What the backend fails of.
    fn target(&mut self, y: &mut [Vector]) -> Result<(), NewtonBackendError>;

    /// Forces out of balance at the iterate: r = -(g - f) over the `counted` free nodes, with the gradient g
    /// of the bodies and known forces f on the watched nodes [N]. The matrix is that of the iterate, with the
    /// matrices of springs.
    ///
    /// # Errors
    /// What the backend fails of.
    fn out_of_balance(
        &mut self,
        springs: &AssemblySprings<'_>,
        known: &[Vector],
        counted: &[bool],
        absolute: bool,
    ) -> Result<OutOfBalance, NewtonBackendError>;
}

/// What is fixed during a time step.
#[derive(Clone, Copy, Debug)]
pub struct NewtonStep<'a> {
    /// Positions x0 at the start [N, m].
    pub start: &'a [Vector],
    /// Where inertia leads [N, m].
    pub inertial: &'a [Vector],
    /// 1 / dt [1/s].
    pub rate: f64,
    /// The blocks of R [N, N/m].
    pub row_sums: &'a [Matrix3<f64>],
    /// The gradient c of the quadratic terms at the start [N, N].
    pub gradient: &'a [Vector],
    /// Values of K by the pairs of [`ElementModel::columns`] [N/m].
    pub bending: &'a [f64],
    /// Values of K by the pairs of [`ElementModel::scalar_columns`] [N/m].
    pub scalars: &'a [f64],
}

/// Where a target begins.
#[derive(Clone, Copy, Debug)]
pub struct NewtonTarget<'a> {
    /// The iterate x [N, m].
    pub iterate: &'a [Vector],
    /// Which nodes are free [N].
    pub free: &'a [bool],
    /// Displacements of the other nodes from the iterate to their ends [N, m]; zero at free nodes.
    pub imposed: &'a [Vector],
    /// Nodes whose positions the host wants to see, ascending.
    pub watched: &'a [u32],
}

/// Positions of the watched nodes [m], in their order.
pub type Watched = Vec<Vector>;

/// When a solve ends, and what follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveLimits {
    /// Residual relative to b, or to the root of `min_scale` if that is larger [1].
    pub tolerance: f64,
    /// Residual relative to b itself at which the solve may end as well [1].
    pub own_tolerance: f64,
    /// Smallest squared norm that `tolerance` is relative to.
    pub min_scale: f64,
    /// Largest number of iterations.
    pub max_iterations: usize,
    /// Whether a search along the step begins next, without translations.
    pub searches: bool,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSolve {
    /// Iterations and residual.
    pub info: CgInfo,
    /// Squared norm of b.
    pub scale: f64,
    /// Whether single precision gained too little, and the CPU had better solve. A residual slightly above
    /// the limit is no reason to: then `info` says that the solve has not converged.
    pub stalled: bool,
}

/// A trial of the line search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trial {
    /// Potential of the bodies at the reference, relative to the quadratic terms at the start of the time
    /// step [J].
    pub reference: f64,
    /// Change of the potential of the bodies since the reference [J].
    pub change: f64,
    /// Error that rounding may make in the change [J].
    pub rounding: f64,
    /// p.b, of the step p and the right-hand side b of the last solve [J]; 0 before one.
    pub predicted: f64,
    /// Largest component of p at full length [m].
    pub largest_step: f64,
    /// Largest distance of a free node from the iterate [m].
    pub from_iterate: f64,
    /// Largest distance of a free node from the iterate that the target began with [m].
    pub from_start: f64,
    /// Positions of the watched nodes.
    pub watched: Watched,
}

/// Forces out of balance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutOfBalance {
    /// Squared norm of r [N^2].
    pub squared_force: f64,
    /// r.M r of the nodes of each of [`ElementModel::components`] [J].
    pub products: Vec<f64>,
}
