//! The log barrier by gradient descent (paper, section 3.4), as a backward step: y is the end of the descent
//! step, and the forward step bounds the motion of each vertex towards it, as in the two-way method.
//!
//! y = x - s D^-1 dE/dx, with D by [`Scaling`] and one factor s <= 1 for all vertices. s is halved after a
//! step that raised the energy and raised by a tenth after one that lowered it (the rule of Wang and Yang
//! 2016, applied in each step). While prescribed vertices move, the objective itself changes: values before
//! and after a step cannot be compared, and s stays. A line search is of no use, because vertices move by
//! different fractions of their way.

use super::{BarrierParams, Derivatives, Objective, Scaling};
use bowknot_errors::{Errors, ParamError};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::{
    BackwardStep, CertifiedForward, CollisionScene, ResolveState, Resolver, Statistics, TrustRegionSearch,
};
use nalgebra::Matrix3;

/// Smallest step factor.
const MIN_FACTOR: f64 = 1e-6;

/// A descent step as [`BackwardStep`].
#[derive(Debug, Default)]
pub struct DescentStep {
    objective: Objective,
    derivatives: Derivatives,
    factor: f64,
    /// Energy at the last x [J].
    energy: f64,
    /// Whether prescribed vertices were on their way at the last x.
    led: bool,
    /// Largest |D^-1 dE/dx| of the last step, by blocks [m].
    newton_length: f64,
}

/// Gradient descent with the forward step and the search of the two-way method; `params.solver.forward`
/// of the scene bounds its steps.
///
/// # Errors
/// Parameters out of their range.
pub fn by_descent(
    scene: CollisionScene,
    params: BarrierParams,
) -> Result<Resolver<TrustRegionSearch, DescentStep, CertifiedForward>, Errors<ParamError>> {
    let step = DescentStep::new(&scene, params)?;
    let search = TrustRegionSearch::new(&scene);
    Ok(Resolver::with_stages(scene, search, step, CertifiedForward::default()))
}

impl DescentStep {
    /// Descent steps for the pairs of the scene.
    ///
    /// # Errors
    /// Parameters out of their range.
    pub fn new(scene: &CollisionScene, params: BarrierParams) -> Result<Self, Errors<ParamError>> {
        Ok(Self { objective: Objective::new(scene, params)?, ..Self::default() })
    }

    /// E at the x that the last step started from [J].
    pub fn energy(&self) -> f64 {
        self.energy
    }
}

impl BackwardStep for DescentStep {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.objective.begin(scene, state);
        self.factor = 1.0;
        self.energy = f64::INFINITY;
        self.led = false;
        self.newton_length = f64::INFINITY;
    }

    fn project(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let contacts = self.objective.contacts(scene, state);
        let energy = self.objective.value(scene, state, &state.x, &contacts);
        if !self.led {
            self.factor = if energy > self.energy {
                (0.5 * self.factor).max(MIN_FACTOR)
            } else {
                (1.1 * self.factor).min(1.0)
            };
        }
        self.energy = energy;
        let arrival = self.objective.params().tolerance * scene.lengths().edge;
        let is_led = |v: usize| !state.is_movable(v) && (state.target[v] - state.x[v]).norm() > arrival;
        self.led = (0..state.x.len()).any(is_led);
        self.objective.derivatives(scene, state, &state.x, &contacts, &mut self.derivatives);
        self.newton_length = 0.0;
        for v in 0..state.x.len() {
            if !state.is_movable(v) {
                state.y[v] = state.target[v];
                continue;
            }
            let gradient = &self.derivatives.gradient[v];
            let newton = solve(&self.derivatives.blocks[v], gradient);
            self.newton_length = self.newton_length.max(newton.norm());
            let step = match self.objective.params().scaling {
                Scaling::Blocks => newton,
                Scaling::Mass => gradient / self.objective.inertia(scene, state, v),
            };
            state.y[v] = state.x[v] - self.factor * step;
        }
        statistics.contact_rows = contacts.len();
        statistics.active_rows = contacts.len();
    }

    fn converged(&self, scene: &CollisionScene, state: &ResolveState) -> Option<bool> {
        let tolerance = self.objective.params().tolerance * scene.lengths().edge;
        Some(self.newton_length <= tolerance && state.remaining <= tolerance)
    }

    fn finish(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        self.objective.report(scene, state, &mut self.derivatives, statistics);
    }
}

/// block^-1 gradient. Blocks are the inertia times the identity plus positive semidefinite matrices.
fn solve(block: &Matrix3<f64>, gradient: &Vector) -> Vector {
    match block.cholesky() {
        Some(factor) => factor.solve(gradient),
        None => gradient / block.trace(),
    }
}
