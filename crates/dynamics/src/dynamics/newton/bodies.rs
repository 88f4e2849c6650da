//! The bodies of a Newton iteration, wherever they are computed: on the CPU in double precision, or on a
//! device.
//!
//! Newton's method is written once, over this trait: it decides, the bodies compute. Vectors over all nodes
//! stay with the bodies. Springs act on the *watched* nodes, whose positions come back.

use super::backend::NewtonBackendError;
use crate::elements::filter::Filter;
use crate::groups::Group;
use crate::linear::accuracy::{CgInfo, Limits};
use crate::linear::parts::Parts;
use crate::linear::springs::LinearSprings;
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::Vector;

/// Why bodies on a device cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum Lost {
    /// The device has failed.
    #[error(transparent)]
    Failed(NewtonBackendError),
    /// Single precision gains nothing.
    #[error("single precision gains nothing")]
    Stalled,
}

impl From<NewtonBackendError> for Lost {
    fn from(error: NewtonBackendError) -> Self {
        Self::Failed(error)
    }
}

/// What bodies answer.
pub type Answer<T> = Result<T, Lost>;

/// State and operations of a target: the iterate x, the step p, the trial, and one kept trial.
pub trait Bodies: Send {
    /// Computes gradient and matrix of the bodies at the iterate, without springs.
    fn linearize(&mut self, filter: Filter) -> Answer<()>;

    /// The watched nodes at the iterate [m].
    fn iterate(&self) -> Vec<Vector>;

    /// The watched nodes where free ones are at the iterate and the others at their ends [m].
    fn iterate_at_ends(&self) -> Vec<Vector>;

    /// The watched nodes where inertia leads free ones, the others at their ends [m].
    fn inertial_at_ends(&self) -> Vec<Vector>;

    /// Solves for the step, with linearized springs added to gradient and matrix. The system has independent
    /// `parts`. Then translates each of the `groups` of components, all of whose nodes are free, so that its
    /// linear momentum in its free directions is conserved whatever the error of the solve.
    fn solve(
        &mut self,
        springs: &LinearSprings,
        parts: &Parts,
        limits: &Limits,
        groups: &[Group],
    ) -> Answer<LinearSolve>;

    /// Begins a search along the step: places the trial at a length of 0, from which changes of energy count.
    /// The next trial is that at full length.
    fn begin_search(&mut self) -> Answer<BodyEnergies> {
        self.place(0.0)
    }

    /// Sets the trial to the iterate plus `length` times the step, with nodes that are not free at their
    /// ends.
    fn place(&mut self, length: f64) -> Answer<BodyEnergies>;

    /// What the step promises; after a [`Self::place`].
    fn promise(&mut self) -> Promise;

    /// The watched nodes at the trial [m].
    fn trial(&self) -> Vec<Vector>;

    /// Largest distance of a free node at the trial from the iterate [m].
    fn distance_from_iterate(&self) -> f64;

    /// Largest distance of a free node at the trial from where the target began [m].
    fn distance_from_start(&self) -> f64;

    /// Makes the trial the iterate.
    fn start_from_trial(&mut self) -> Answer<()>;

    /// Keeps the trial.
    fn keep_trial(&mut self) -> Answer<()>;

    /// Makes the kept trial the iterate.
    fn start_from_kept_trial(&mut self) -> Answer<()>;

    /// The forces that are out of balance at the iterate, with the known forces of the springs, over
    /// `counted` free nodes.
    fn out_of_balance(
        &mut self,
        repulsion: &Repulsion,
        counted: &[bool],
        filter: Filter,
    ) -> Answer<Imbalance>;
}

/// How a linear solve ended.
#[derive(Clone, Debug)]
pub struct LinearSolve {
    pub info: CgInfo,
    /// Squared norms of the right-hand side by part; all are that of the whole where parts are solved as one.
    pub scales: Vec<f64>,
}

/// The potential of the bodies at a trial [J].
#[derive(Clone, Copy, Debug, Default)]
pub struct BodyEnergies {
    /// Inertia and air.
    pub kinetic: f64,
    /// Elements.
    pub internal: f64,
    /// What rounding to single precision may change of the difference to the beginning of the search.
    pub rounding: f64,
}

/// What a step promises.
#[derive(Clone, Copy, Debug)]
pub struct Promise {
    /// p.b: twice the decrease of the quadratic model [J].
    pub predicted: f64,
    /// Whether the step is a rounding error of the positions.
    pub is_negligible: bool,
}

/// Forces out of balance.
#[derive(Clone, Debug)]
pub struct Imbalance {
    /// Sum of squared forces [N^2].
    pub squared_force: f64,
    /// Forces times preconditioned forces, by component [J].
    pub products: Vec<f64>,
}
