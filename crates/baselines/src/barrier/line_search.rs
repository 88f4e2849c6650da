//! One step size for all vertices: at most that of the earliest impact, then halved until the energy does not
//! rise (Li et al. 2020, Algorithm 1).

use super::Objective;
use crate::ccd::{AdditiveCcd, PathTime, SweptSearch, earliest};
use bowknot_twoway::geometry::{Point, Vector};
use bowknot_twoway::stepper::{StepReport, Stepper};
use bowknot_twoway::{CollisionScene, ForwardStep, ResolveState, Statistics};

/// Largest number of halvings; then nothing moves.
const MAX_HALVINGS: usize = 40;
/// Relative rounding of the energy.
const ROUNDING: f64 = 1e-13;

/// The forward step of [`super::by_newton`].
///
/// While prescribed vertices move, the objective itself changes, and its values before and after a step
/// cannot be compared. Such steps are limited by impacts alone.
#[derive(Debug, Default)]
pub struct LineSearch {
    objective: Objective,
    ccd: AdditiveCcd,
    stepper: Stepper,
    paths: Vec<Vector>,
}

impl LineSearch {
    /// A line search on the backward step's objective.
    pub fn new(objective: &Objective, ccd: AdditiveCcd) -> Self {
        Self { objective: objective.sharing(), ccd, ..Self::default() }
    }

    /// The largest of `step`, half of it, .. that does not raise the energy; 0 after too many halvings.
    fn backtrack(&self, scene: &CollisionScene, state: &ResolveState, mut step: f64) -> f64 {
        let value = |x: &[Point]| {
            let contacts = self.objective.contacts_at(scene, state, x);
            self.objective.value(scene, state, x, &contacts)
        };
        let contacts = self.objective.contacts(scene, state);
        let before = self.objective.value(scene, state, &state.x, &contacts);
        for _ in 0..MAX_HALVINGS {
            let x: Vec<Point> = state.x.iter().zip(&self.paths).map(|(x, p)| x + step * p).collect();
            if value(&x) <= before * (1.0 + ROUNDING) {
                return step;
            }
            step *= 0.5;
        }
        0.0
    }
}

impl ForwardStep<SweptSearch> for LineSearch {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.objective.begin(scene, state);
        self.stepper.begin(scene.rest().len());
    }

    fn advance(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut SweptSearch,
        statistics: &mut Statistics,
    ) -> StepReport {
        self.stepper.set_target(&state.x, &state.y);
        self.paths.clear();
        self.paths.extend_from_slice(self.stepper.displacements());
        search.list(scene, state, &self.paths, PathTime::Common, statistics);
        let mut step = earliest(&self.ccd, scene, state, &self.paths);
        let still = |v: usize| state.is_movable(v) || self.paths[v] == Vector::zeros();
        if (0..self.paths.len()).all(still) {
            step = self.backtrack(scene, state, step);
        }
        for v in 0..self.paths.len() {
            self.stepper.limit(v, step);
        }
        state.previous.clone_from(&state.x);
        self.stepper.advance(&mut state.x)
    }
}
