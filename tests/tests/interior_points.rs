//! The baselines also guarantee that no straight path of any step intersects. The judge decides this exactly.

use crate::safety::{seeds, watched};
use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact};
use bowknot_errors::{Errors, ParamError};
use bowknot_stepper::{StepReport, Stepper};
use bowknot_twoway::{
    CollisionScene, ForwardStep, LcpBackward, Params, ResolveError, ResolveState, Resolver, Search,
    Statistics, TrustRegionSearch,
};

/// Presets and speeds in turn. With a minimum separation: where a tenth of the gap is left step by step, it
/// falls to 1e-12 m within these few steps, too near for the judge to tell a miss from a hit. With few
/// iterations: along a kilometer there would be many, and stopping early is as safe.
fn with_impacts<F: ForwardStep>(forward: impl Fn(AdditiveCcd) -> Result<F, Errors<ParamError>>) {
    let settings = [(Params::fast(), ClosingSpeed::Slab), (Params::paper(), ClosingSpeed::Travel)];
    for (mut params, speed) in settings {
        params.contact.min_separation = Some(1e-8);
        let ccd = AdditiveCcd { speed, max_iterations: 50, ..AdditiveCcd::default() };
        watched(&params, seeds().div_ceil(2), |scene| {
            let search = TrustRegionSearch::new(&scene);
            let backward: LcpBackward = LcpBackward::default();
            let forward = forward(ccd).map_err(ResolveError::Params)?;
            Ok(Resolver::with_stages(scene, search, backward, forward))
        })
        .assert_safe();
    }
}

#[test]
fn no_step_of_the_log_barrier_by_descent_intersects() {
    for params in [Params::fast(), Params::paper()] {
        let descent = |scene| by_descent(scene, BarrierParams::default()).map_err(ResolveError::Params);
        watched(&params, seeds(), descent).assert_safe();
    }
}

#[test]
fn no_step_of_the_log_barrier_by_newtons_method_intersects() {
    let mut params = Params::fast();
    params.contact.min_separation = Some(1e-8);
    let ccd = AdditiveCcd { speed: ClosingSpeed::Slab, max_iterations: 50, ..AdditiveCcd::default() };
    let newton = |scene| by_newton(scene, BarrierParams::default(), ccd).map_err(ResolveError::Params);
    watched(&params, seeds().div_ceil(2), newton).assert_safe();
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

impl ForwardStep for Unlimited {
    fn begin(&mut self, scene: &CollisionScene, _: &ResolveState) {
        self.0.begin(scene.vertex_count());
    }

    fn advance(
        &mut self,
        _: &CollisionScene,
        state: &mut ResolveState,
        _: &mut dyn Search,
        _: &mut Statistics,
    ) -> StepReport {
        self.0.set_target(&state.x, &state.y);
        state.previous.clone_from(&state.x);
        self.0.advance(&mut state.x)
    }
}

#[test]
fn steps_that_ignore_impacts_are_found() {
    let mut params = Params::fast();
    params.contact.min_separation = Some(1e-8);
    let outcome = watched(&params, 1, |scene| {
        let search = TrustRegionSearch::new(&scene);
        let backward: LcpBackward = LcpBackward::default();
        Ok(Resolver::with_stages(scene, search, backward, Unlimited::default()))
    });
    assert!(outcome.caught() >= 0.1, "{} of the runs", outcome.caught());
}
