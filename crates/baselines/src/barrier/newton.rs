//! The log barrier by projected Newton steps (Li et al. 2020, "Incremental Potential Contact"), as a backward
//! step: y = x + p with H p = -dE/dx, H the Hessian with every element made positive semidefinite.
//!
//! Prescribed vertices in contact move by at most half of the barrier's range per step, and the step of the
//! other vertices is solved for with this motion given: an obstacle pushes what is in its way. If prescribed
//! vertices moved all the way, impacts would make the common step size too small for anything to get out of
//! their way.

use super::cholesky::Cholesky;
use super::hessian::elements;
use super::params::diagonal;
use super::stiffness::AdaptiveStiffness;
use super::system::System;
use super::{BarrierForm, BarrierParams, Contact, Derivatives, LineSearch, LinearSolver, Objective};
use crate::ccd::{AdditiveCcd, SweptSearch};
use bowknot_errors::{Errors, ParamError, Parameters};
use bowknot_twoway::geometry::{Point, Vector};
use bowknot_twoway::{BackwardStep, CollisionScene, ResolveState, Resolver, Statistics};

/// First inertia that an indefinite system gets, over its largest entry.
const SMALLEST_SHIFT: f64 = 1e-15;
/// Factor on it until the system is definite.
const SHIFT_GROWTH: f64 = 10.0;
/// Then the largest entry is exceeded, and the matrix is not finite.
const MAX_SHIFTS: usize = 18;

/// A Newton step as [`BackwardStep`].
#[derive(Debug, Default)]
pub struct NewtonStep {
    objective: Objective,
    derivatives: Derivatives,
    step: Vec<Vector>,
    stiffness: Option<AdaptiveStiffness>,
    /// Length of the longest step of a vertex [m].
    longest: f64,
}

/// Newton's method with the forward step of IPC: all vertices move up to the earliest impact, then half as
/// far until the energy falls.
///
/// # Errors
/// Parameters out of their range.
pub fn by_newton(
    scene: CollisionScene,
    params: BarrierParams,
    ccd: AdditiveCcd,
) -> Result<Resolver<SweptSearch, NewtonStep, LineSearch>, Errors<ParamError>> {
    ccd.validate()?;
    let step = NewtonStep::new(&scene, params)?;
    let line_search = LineSearch::new(&step.objective, ccd);
    let search = SweptSearch::new(&scene);
    Ok(Resolver::with_stages(scene, search, step, line_search))
}

impl NewtonStep {
    /// Newton steps for the pairs of the scene.
    ///
    /// # Errors
    /// Parameters out of their range.
    pub fn new(scene: &CollisionScene, params: BarrierParams) -> Result<Self, Errors<ParamError>> {
        Ok(Self { objective: Objective::new(scene, params)?, ..Self::default() })
    }
}

impl NewtonStep {
    /// The pairs within range at x, with the stiffness of this step.
    fn adapted_contacts(&mut self, scene: &CollisionScene, state: &ResolveState) -> Vec<Contact> {
        if self.objective.params().form == BarrierForm::Paper {
            return self.objective.contacts(scene, state);
        }
        let mut stiffness = match self.stiffness {
            Some(stiffness) => stiffness,
            None => self.balanced(scene, state),
        };
        self.objective.set_strength(stiffness.value);
        let mut contacts = self.objective.contacts(scene, state);
        let smallest = contacts.iter().map(|c| c.separation.distance).fold(f64::INFINITY, f64::min);
        stiffness.update(smallest);
        if stiffness.value != self.objective.strength() {
            self.objective.set_strength(stiffness.value);
            contacts = self.objective.contacts(scene, state);
        }
        self.stiffness = Some(stiffness);
        contacts
    }

    /// The stiffness at the start of a call.
    fn balanced(&mut self, scene: &CollisionScene, state: &ResolveState) -> AdaptiveStiffness {
        let inertia = |v: usize| self.objective.inertia(scene, state, v);
        let pull = |v: usize| {
            if state.is_movable(v) { inertia(v) * (state.x[v] - state.target[v]) } else { Vector::zeros() }
        };
        let energy: Vec<Vector> = (0..state.x.len()).map(pull).collect();
        let mean = self.objective.mean_inertia(scene, state);
        self.objective.set_strength(1.0);
        let contacts = self.objective.contacts(scene, state);
        self.objective.derivatives(scene, state, &state.x, &contacts, &mut self.derivatives);
        let push: Vec<Vector> = self.derivatives.gradient.iter().zip(&energy).map(|(g, e)| g - e).collect();
        let range = self.objective.largest_range(scene);
        AdaptiveStiffness::balanced(diagonal(&state.start), range, mean, &energy, &push)
    }

    /// Displacements of prescribed vertices in this step [m]; 0 for the others.
    fn given(&self, scene: &CollisionScene, state: &ResolveState, contacts: &[Contact]) -> Vec<Vector> {
        let way = |v: usize| {
            if state.is_movable(v) { Vector::zeros() } else { state.target[v] - state.x[v] }
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
        self.stiffness = None;
        self.longest = f64::INFINITY;
    }

    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let contacts = self.adapted_contacts(scene, state);
        self.objective.derivatives(scene, state, &state.x, &contacts, &mut self.derivatives);
        let elements = elements(&self.objective, &state.x, &contacts);
        let inertia =
            |v: usize| if state.is_movable(v) { self.objective.inertia(scene, state, v) } else { 0.0 };
        let inertia: Vec<f64> = (0..state.x.len()).map(inertia).collect();
        let mut down: Vec<Vector> = self.derivatives.gradient.iter().map(|g| -g).collect();
        let system = System::new(&inertia, &elements);
        let given = self.given(scene, state, &contacts);
        if given.iter().any(|d| *d != Vector::zeros()) {
            let mut dragged = vec![Vector::zeros(); down.len()];
            system.multiply(&given, &mut dragged);
            down.iter_mut().zip(&dragged).for_each(|(down, dragged)| *down -= dragged);
        }
        self.step = down;
        match self.objective.params().linear_solver {
            LinearSolver::Cholesky => factor_and_solve(&system, &state.x, &mut self.step),
            LinearSolver::ConjugateGradients => _ = system.iterate(&mut self.step),
        }
        self.longest = self.step.iter().map(Vector::norm).fold(0.0, f64::max);
        for v in 0..state.x.len() {
            state.y[v] = state.x[v] + if state.is_movable(v) { self.step[v] } else { given[v] };
        }
        statistics.contact_rows = contacts.len();
        statistics.active_rows = contacts.len();
    }

    fn converged(&self, scene: &CollisionScene, state: &ResolveState) -> Option<bool> {
        let tolerance = self.objective.params().tolerance * scene.lengths().edge;
        let arrived = |v: usize| state.is_movable(v) || (state.target[v] - state.x[v]).norm() <= tolerance;
        Some(self.longest <= tolerance && (0..state.x.len()).all(arrived))
    }

    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        self.objective.report(scene, state, &mut self.derivatives, statistics);
    }
}

/// Solves the system in place. Where rounding makes it indefinite, because the barrier is stiffer than the
/// inertia by more digits than there are, it gets more inertia: the step is shorter, and still descends.
fn factor_and_solve(system: &System, positions: &[Point], step: &mut [Vector]) {
    let mut inertia = 0.0;
    for _ in 0..MAX_SHIFTS {
        if let Some(factor) = Cholesky::new(system, inertia, positions) {
            return factor.solve(step);
        }
        inertia = if inertia == 0.0 { SMALLEST_SHIFT * system.largest() } else { SHIFT_GROWTH * inertia };
    }
    step.fill(Vector::zeros());
}
