//! The two-phase scheme of Wu et al. 2020: soft, then hard.

use super::{ImpactZones, ZoneParams};
use crate::{Method, Outcome};
use bowknot_twoway::geometry::Point;
use bowknot_twoway::{CollisionScene, ResolveError, ResolveInput};
use std::time::Instant;

/// The soft and the hard phase of Wu et al. 2020 ("A safe and fast repulsion method for GPU-based cloth self collisions";
/// two-way paper, section 1.3): some rounds of impact-zone optimisation move the target without a promise; where the path
/// to it is still not free, an interior point method goes from x towards it and stops wherever it gets.
///
/// Theirs works on pairs of vertices of fine meshes, in both phases; here both work on all kinds of pairs, as
/// everything else that is compared. The hard phase is any method that never fails: a log barrier by gradient descent, as
/// theirs.
#[derive(Debug)]
pub struct TwoPhase<H> {
    name: String,
    soft: ImpactZones,
    hard: H,
    fallbacks: usize,
}

impl<H: Method> TwoPhase<H> {
    /// Of the scene in `problem`, with so many rounds at most in the soft phase; `hard` is a method for the same scene.
    pub fn new(scene: CollisionScene, soft_rounds: usize, hard: H) -> Self {
        let params = ZoneParams { max_iterations: soft_rounds, ..ZoneParams::default() };
        let name = format!("two phases, hard: {}", hard.name());
        Self { name, soft: ImpactZones::new(scene, params), hard, fallbacks: 0 }
    }

    /// Calls so far that needed the hard phase.
    pub fn fallbacks(&self) -> usize {
        self.fallbacks
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
        let clock = Instant::now();
        let mut outcome = Outcome::default();
        let attempt = self.soft.optimise(positions, target, input, &mut outcome)?;
        if attempt.clear {
            positions.copy_from_slice(&attempt.target);
            outcome.converged = true;
        } else {
            self.fallbacks += 1;
            // Rows that contradict each other may have sent it far; beyond all bounds it is of no use.
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
        outcome.seconds.total = clock.elapsed().as_secs_f64();
        Ok(outcome)
    }
}
