//! What the methods to compare with promise as well: no straight path of any step intersects, judged exactly.

use crate::safety::{seeds, watched};
use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact};
use bowknot_stepper::{StepReport, Stepper};
use bowknot_twoway::{
    BudgetedSearch, ForwardStep, LcpBackward, Params, Problem, Resolver, Search, State, Statistics,
};

/// Presets and speeds in turn. With a floor: where a tenth of the gap is left step by step, it falls to 1e-12 m within these
/// few steps, too near for the judge to tell a miss from a hit. With few iterations: along a kilometre there would be many,
/// and stopping early is as safe.
fn with_impacts<F: ForwardStep>(forward: impl Fn(AdditiveCcd) -> F) {
    let settings = [(Params::fast(), ClosingSpeed::Slab), (Params::paper(), ClosingSpeed::Travel)];
    for (mut params, speed) in settings {
        params.stepper.floor = Some(1e-8);
        let ccd = AdditiveCcd { speed, max_iterations: 50, ..AdditiveCcd::default() };
        watched(&params, seeds().div_ceil(2), |problem| {
            let search = BudgetedSearch::new(&problem);
            let backward: LcpBackward = LcpBackward::default();
            Ok(Resolver::with_stages(problem, search, backward, forward(ccd)))
        })
        .assert_safe();
    }
}

#[test]
fn no_step_of_the_log_barrier_by_descent_intersects() {
    for params in [Params::fast(), Params::paper()] {
        let descent =
            |problem| by_descent(problem, BarrierParams::default()).expect("the defaults are sound");
        watched(&params, seeds(), |problem| Ok(descent(problem))).assert_safe();
    }
}

#[test]
fn no_step_of_the_log_barrier_by_newtons_method_intersects() {
    let mut params = Params::fast();
    params.stepper.floor = Some(1e-8);
    let ccd = AdditiveCcd { speed: ClosingSpeed::Slab, max_iterations: 50, ..AdditiveCcd::default() };
    let newton =
        |problem| by_newton(problem, BarrierParams::default(), ccd).expect("the parameters are sound");
    watched(&params, seeds().div_ceil(2), |problem| Ok(newton(problem))).assert_safe();
}

#[test]
fn no_step_to_the_earliest_impact_intersects() {
    with_impacts(EarliestImpact::new);
}

#[test]
fn no_step_to_each_vertexs_impact_intersects() {
    with_impacts(PerVertexImpact::new);
}

/// Goes all the way, whatever is in it.
#[derive(Default)]
struct Heedless(Stepper);

impl ForwardStep for Heedless {
    fn begin(&mut self, problem: &Problem, _: &State) {
        self.0.begin(problem.rest.len());
    }

    fn advance(
        &mut self,
        _: &Problem,
        state: &mut State,
        _: &mut dyn Search,
        _: &mut Statistics,
    ) -> StepReport {
        self.0.aim(&state.x, &state.y);
        state.previous.clone_from(&state.x);
        self.0.advance(&mut state.x)
    }
}

#[test]
fn steps_that_heed_no_impact_are_caught() {
    let mut params = Params::fast();
    params.stepper.floor = Some(1e-8);
    let outcome = watched(&params, 1, |problem| {
        let search = BudgetedSearch::new(&problem);
        let backward: LcpBackward = LcpBackward::default();
        Ok(Resolver::with_stages(problem, search, backward, Heedless::default()))
    });
    assert!(outcome.caught() >= 0.1, "{} of the runs", outcome.caught());
}
