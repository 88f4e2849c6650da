//! The log barrier by projected Newton steps (Li et al. 2020, "Incremental Potential Contact"), as a backward step: y = x + p
//! with H p = -dE/dx, H the Hessian with every element made positive semidefinite.
//!
//! Prescribed vertices that are in contact come by at most half of the barrier's range a step, and the others' step is solved for
//! with theirs given: what is in the way of an obstacle goes along with it. Going all their way, they would leave a step
//! size for all that lets nothing get out of their way.

use super::hessian::elements;
use super::system::System;
use super::{BarrierParams, Contact, Derivatives, LineSearch, Objective};
use crate::ccd::AdditiveCcd;
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::{
    BackwardStep, CollisionScene, ResolveError, ResolveState, Resolver, Statistics, TrustRegionSearch,
};

/// Relative residual of the Newton systems.
const TOLERANCE: f64 = 1e-4;
/// Largest number of iterations of a solve.
const MAX_ITERATIONS: usize = 2000;

/// A Newton step as [`BackwardStep`].
#[derive(Debug, Default)]
pub struct NewtonStep {
    objective: Objective,
    derivatives: Derivatives,
    step: Vec<Vector>,
    /// See [`Self::decrement`].
    decrement: f64,
    solver_iterations: usize,
}

/// Newton's method with IPC's forward step: all vertices by the earliest impact, then half as far until the energy falls.
///
/// # Errors
/// Parameters out of their range.
pub fn by_newton(
    scene: CollisionScene,
    params: BarrierParams,
    ccd: AdditiveCcd,
) -> Result<Resolver<TrustRegionSearch, NewtonStep, LineSearch>, ResolveError> {
    let step = NewtonStep::new(&scene, params.clone())?;
    let line_search = LineSearch::new(&scene, params, ccd)?;
    let search = TrustRegionSearch::new(&scene);
    Ok(Resolver::with_stages(scene, search, step, line_search))
}

impl NewtonStep {
    /// Newton steps for the problem's pairs.
    ///
    /// # Errors
    /// Parameters out of their range.
    pub fn new(scene: &CollisionScene, params: BarrierParams) -> Result<Self, ResolveError> {
        Ok(Self { objective: Objective::new(scene, params)?, ..Self::default() })
    }

    /// Newton decrement of the last step as a length [m]: sqrt(-p . dE/dx / sum m/dt^2), the root mean square of the way to
    /// the minimum that the quadratic model promises, weighted as the objective weighs it.
    pub fn decrement(&self) -> f64 {
        self.decrement
    }

    /// Iterations of conjugate gradients in the present call.
    pub fn solver_iterations(&self) -> usize {
        self.solver_iterations
    }
}

impl NewtonStep {
    /// Where prescribed vertices go in this step [m]; 0 for the others.
    fn given(&self, scene: &CollisionScene, state: &ResolveState, contacts: &[Contact]) -> Vec<Vector> {
        let way = |v: usize| match state.is_movable(v) {
            true => Vector::zeros(),
            false => state.target[v] - state.x[v],
        };
        let mut given: Vec<Vector> = (0..state.x.len()).map(way).collect();
        let moves = |v: &u32| given[*v as usize] != Vector::zeros();
        if contacts.iter().any(|c| c.vertices[..c.kind.vertex_count()].iter().any(moves)) {
            let longest = given.iter().map(Vector::norm).fold(0.0, f64::max);
            let share = (0.5 * self.objective.largest_range(scene) / longest).min(1.0);
            given.iter_mut().for_each(|d| *d *= share);
        }
        given
    }
}

impl BackwardStep for NewtonStep {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.objective.begin(scene, state);
        self.decrement = f64::INFINITY;
        self.solver_iterations = 0;
    }

    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let contacts = self.objective.contacts(scene, state);
        self.objective.derivatives(scene, state, &state.x, &contacts, &mut self.derivatives);
        let elements = elements(&self.objective, &state.x, &contacts);
        let inertia = |v: usize| match state.is_movable(v) {
            true => self.objective.inertia(scene, state, v),
            false => 0.0,
        };
        let inertia: Vec<f64> = (0..state.x.len()).map(inertia).collect();
        let mut down: Vec<Vector> = self.derivatives.gradient.iter().map(|g| -g).collect();
        let system = System::new(&inertia, &elements);
        let given = self.given(scene, state, &contacts);
        if given.iter().any(|d| *d != Vector::zeros()) {
            let mut dragged = vec![Vector::zeros(); down.len()];
            system.multiply(&given, &mut dragged);
            down.iter_mut().zip(&dragged).for_each(|(down, dragged)| *down -= dragged);
        }
        let report = system.solve(&down, TOLERANCE, MAX_ITERATIONS, &mut self.step);
        self.solver_iterations += report.iterations;
        let promised: f64 = self.step.iter().zip(&down).map(|(p, g)| p.dot(g)).sum();
        let total: f64 = inertia.iter().sum();
        self.decrement = if total > 0.0 { (promised.max(0.0) / total).sqrt() } else { 0.0 };
        for v in 0..state.x.len() {
            state.y[v] = state.x[v] + if state.is_movable(v) { self.step[v] } else { given[v] };
        }
        statistics.contact_rows = contacts.len();
        statistics.active_rows = contacts.len();
    }

    fn converged(&self, scene: &CollisionScene, state: &ResolveState) -> Option<bool> {
        let tolerance = self.objective.params().tolerance * scene.lengths().edge;
        let arrived = |v: usize| state.is_movable(v) || (state.target[v] - state.x[v]).norm() <= tolerance;
        Some(self.decrement <= tolerance && (0..state.x.len()).all(arrived))
    }

    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        self.objective.report(scene, state, &mut self.derivatives, statistics);
    }
}
