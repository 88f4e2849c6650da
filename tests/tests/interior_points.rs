//! The baselines also guarantee that no straight path of any step intersects. The judge decides this exactly.

use crate::safety::{seeds, watched};
use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact};
use bowknot_stepper::{StepReport, Stepper};
use bowknot_twoway::{
    BudgetedSearch, ForwardStep, LcpBackward, Params, Problem, Resolver, Search, State, Statistics,
};

/// Checks both presets, each with one closing speed. There is a smallest separation, because a gap of which a
/// tenth is left in each step falls to 1e-12 m within these few steps, too small for the judge to tell a miss
/// from a hit. The number of iterations is limited, because a path of a kilometre would need many, and
/// stopping early is as safe.
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
        watched(&params, seeds(), |problem| by_descent(problem, BarrierParams::default())).assert_safe();
    }
}

#[test]
fn no_step_of_the_log_barrier_by_newtons_method_intersects() {
    let mut params = Params::fast();
    params.stepper.floor = Some(1e-8);
    let ccd = AdditiveCcd { speed: ClosingSpeed::Slab, max_iterations: 50, ..AdditiveCcd::default() };
    watched(&params, seeds().div_ceil(2), |problem| by_newton(problem, BarrierParams::default(), ccd))
        .assert_safe();
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
fn steps_that_ignore_impacts_are_found() {
    let mut params = Params::fast();
    params.stepper.floor = Some(1e-8);
    let outcome = watched(&params, 1, |problem| {
        let search = BudgetedSearch::new(&problem);
        let backward: LcpBackward = LcpBackward::default();
        Ok(Resolver::with_stages(problem, search, backward, Unlimited::default()))
    });
    assert!(outcome.caught() >= 0.1, "{} of the runs", outcome.caught());
}
