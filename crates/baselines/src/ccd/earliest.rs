//! One step size for all vertices: that of the earliest impact (Li et al. 2020, "Incremental Potential
//! Contact").

use super::additive::AdditiveCcd;
use super::pairs::candidate_clearance;
use super::swept::{PathTime, SweptSearch};
use bowknot_errors::{Errors, ParamError, Parameters};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::stepper::{StepReport, Stepper};
use bowknot_twoway::{CollisionScene, ForwardStep, ResolveState, Statistics};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Smallest number of pairs of a parallel task.
const CHUNK: usize = 256;

/// Moves all vertices by one fraction of their ways: that at which the first pair would meet.
#[derive(Debug, Default)]
pub struct EarliestImpact {
    ccd: AdditiveCcd,
    stepper: Stepper,
    paths: Vec<Vector>,
}

impl EarliestImpact {
    /// With these parameters of the CCD.
    ///
    /// # Errors
    /// Parameters out of their range.
    pub fn new(ccd: AdditiveCcd) -> Result<Self, Errors<ParamError>> {
        ccd.validate()?;
        Ok(Self { ccd, ..Self::default() })
    }
}

/// The smallest clearance of all candidate pairs along `paths` [m]; 1 without impact.
pub(crate) fn earliest(
    ccd: &AdditiveCcd,
    scene: &CollisionScene,
    state: &ResolveState,
    paths: &[Vector],
) -> f64 {
    // Non-negative floats have the order of their bits.
    let first = AtomicU64::new(1.0f64.to_bits());
    (0..state.contacts.pairs.len()).into_par_iter().with_min_len(CHUNK).for_each(|p| {
        let until = f64::from_bits(first.load(Ordering::Relaxed));
        let time = candidate_clearance(ccd, scene, state, paths, p, until).time;
        first.fetch_min(time.to_bits(), Ordering::Relaxed);
    });
    f64::from_bits(first.into_inner())
}

impl ForwardStep<SweptSearch> for EarliestImpact {
    fn begin(&mut self, scene: &CollisionScene, _: &ResolveState) {
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
        let time = earliest(&self.ccd, scene, state, &self.paths);
        for v in 0..self.paths.len() {
            self.stepper.limit(v, time);
        }
        state.previous.clone_from(&state.x);
        self.stepper.advance(&mut state.x)
    }
}
