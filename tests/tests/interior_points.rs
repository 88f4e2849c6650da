//! The baselines also guarantee that no straight path of any step intersects. The judge decides this exactly.

use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact, SweptSearch};
use bowknot_errors::{Errors, ParamError};
use bowknot_safety::scenario::{Preset, plain};
use bowknot_safety::search::{failing_share, search_many};
use bowknot_safety::trial::{Judged, check_with};
use bowknot_stepper::{StepReport, Stepper};
use bowknot_twoway::{
    BackwardStep, CollisionScene, ForwardStep, LcpBackward, ResolveError, ResolveState, Resolver, Search,
    Statistics, TrustRegionSearch,
};

/// How many times the usual number of problems is drawn, times two.
pub fn seeds() -> u64 {
    std::env::var("BOWKNOT_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(2)
}

/// Checks every step of a loop of stages, from generated states to all kinds of targets.
fn watched<S: Search, B: BackwardStep, F: ForwardStep<S>>(
    preset: Preset,
    floor: f64,
    stages: impl Fn(CollisionScene) -> Result<Resolver<S, B, F>, ResolveError> + Sync,
) {
    let check = |scenario: &_| check_with(scenario, Judged::Safety, &stages);
    let outcome = search_many(3, 24 * seeds(), || plain(preset, floor), check);
    let tally = outcome.unwrap_or_else(|failure| panic!("{failure}"));
    // A method that never moves anything is safe but useless.
    assert!(10 * tally.moved >= 9 * tally.cases, "{tally:?}");
}

/// Presets and speeds in turn. With a minimum separation: where a tenth of the gap is left step by step, it
/// falls to 1e-12 m within these few steps, too near for the judge to tell a miss from a hit. With few
/// iterations: along a kilometer there would be many, and stopping early is as safe.
fn with_impacts<F: ForwardStep<SweptSearch>>(
    forward: impl Fn(AdditiveCcd) -> Result<F, Errors<ParamError>> + Sync,
) {
    for (preset, speed) in [(Preset::Fast, ClosingSpeed::Slab), (Preset::Paper, ClosingSpeed::Travel)] {
        let ccd = AdditiveCcd { speed, max_iterations: 50, ..AdditiveCcd::default() };
        watched(preset, 1e-8, |scene| {
            let search = SweptSearch::new(&scene);
            let backward = LcpBackward::new();
            let forward = forward(ccd).map_err(ResolveError::Params)?;
            Ok(Resolver::with_stages(scene, search, backward, forward))
        });
    }
}

#[test]
fn no_step_of_the_log_barrier_by_descent_intersects() {
    for preset in [Preset::Fast, Preset::Paper] {
        let descent = |scene| by_descent(scene, BarrierParams::default()).map_err(ResolveError::Params);
        watched(preset, 1e-8, descent);
    }
}

#[test]
fn no_step_of_the_log_barrier_by_newtons_method_intersects() {
    let ccd = AdditiveCcd { speed: ClosingSpeed::Slab, max_iterations: 50, ..AdditiveCcd::default() };
    for params in [BarrierParams::default(), BarrierParams::ipc()] {
        let newton = |scene| by_newton(scene, params.clone(), ccd).map_err(ResolveError::Params);
        watched(Preset::Fast, 1e-8, newton);
    }
}

#[test]
fn no_step_to_the_earliest_impact_intersects() {
    with_impacts(EarliestImpact::new);
}

#[test]
fn no_step_to_each_vertexs_impact_intersects() {
    with_impacts(PerVertexImpact::new);
}

/// Goes the whole way, whether or not anything is in it.
#[derive(Default)]
struct Unlimited(Stepper);

impl<S: Search> ForwardStep<S> for Unlimited {
    fn begin(&mut self, scene: &CollisionScene, _: &ResolveState) {
        self.0.begin(scene.vertex_count());
    }

    fn advance(
        &mut self,
        _: &CollisionScene,
        state: &mut ResolveState,
        _: &mut S,
        _: &mut Statistics,
    ) -> StepReport {
        self.0.set_target(&state.x, &state.y);
        state.previous.clone_from(&state.x);
        self.0.advance(&mut state.x)
    }
}

#[test]
fn steps_that_ignore_impacts_are_found() {
    let unlimited = |scene: CollisionScene| {
        let search = TrustRegionSearch::new(&scene);
        let backward = LcpBackward::new();
        Ok(Resolver::with_stages(scene, search, backward, Unlimited::default()))
    };
    let check = |scenario: &_| check_with(scenario, Judged::Safety, unlimited);
    let caught = failing_share(3, 48, || plain(Preset::Fast, 1e-8), check);
    assert!(caught >= 0.1, "{caught} of the runs");
}
