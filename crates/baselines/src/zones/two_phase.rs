//! The two-phase scheme of Wu et al. 2020: soft, then hard.

use super::optimizer::ImpactZones;
use super::params::ZoneParams;
use crate::{Method, Outcome};
use bowknot_errors::{Errors, ParamError};
use bowknot_twoway::geometry::Point;
use bowknot_twoway::{CollisionScene, ResolveError, ResolveInput};
use std::time::Instant;

/// The soft and the hard phase of Wu et al. 2020 ("A safe and fast repulsion method for GPU-based cloth self
/// collisions"; two-way paper, section 1.3). Some rounds of impact-zone optimization move the target, without
/// a guarantee. If the path to it still has impacts, an interior point method moves x towards it as far as it
/// can.
///
/// Their phases work on pairs of vertices of fine meshes. Here both work on all kinds of pairs, like all
/// other compared methods. The hard phase is any method that never fails, such as their log barrier by
/// gradient descent.
#[derive(Debug)]
pub struct TwoPhase<H> {
    name: String,
    soft: ImpactZones,
    hard: H,
}

impl<H: Method> TwoPhase<H> {
    /// For `scene`, with at most `soft_rounds` rounds in the soft phase; `hard` is a method
    /// for the same scene.
    ///
    /// # Errors
    /// No round.
    pub fn new(scene: CollisionScene, soft_rounds: usize, hard: H) -> Result<Self, Errors<ParamError>> {
        let params = ZoneParams { max_iterations: soft_rounds, ..ZoneParams::default() };
        let name = format!("two phases, hard: {}", hard.name());
        Ok(Self { name, soft: ImpactZones::new(scene, params)?, hard })
    }
}

impl<H: Method> Method for TwoPhase<H> {
    fn name(&self) -> &str {
        &self.name
    }

    fn solve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<Outcome, ResolveError> {
        let timer = Instant::now();
        let mut outcome = Outcome::default();
        let attempt = self.soft.optimize(positions, target, input, &mut outcome)?;
        if attempt.clear {
            positions.copy_from_slice(&attempt.target);
            outcome.converged = true;
        } else {
            // Contradicting rows may have moved the target to infinity.
            let finite = attempt.target.iter().all(|y| y.iter().all(|c| c.is_finite()));
            let target = if finite { &attempt.target } else { target };
            let hard = self.hard.solve(positions, target, input)?;
            outcome.steps += hard.steps;
            outcome.searches += hard.searches;
            outcome.converged = hard.converged;
            outcome.failed = hard.failed;
            let (sum, more) = (&mut outcome.seconds, &hard.seconds);
            sum.search += more.search;
            sum.evaluate += more.evaluate;
            sum.backward += more.backward;
            sum.forward += more.forward;
        }
        outcome.seconds.total = timer.elapsed().as_secs_f64();
        Ok(outcome)
    }
}
