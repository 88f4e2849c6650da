//! What the methods to compare with promise as well: no straight path of any step intersects, judged exactly.

use crate::safety::{seeds, watched};
use bowknot_baselines::barrier::{BarrierParams, by_descent, by_newton};
use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed, EarliestImpact, PerVertexImpact};
use bowknot_twoway::{BudgetedSearch, ForwardStep, LcpBackward, Params, Resolver};

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
        });
    }
}

#[test]
fn no_step_of_the_log_barrier_by_descent_intersects() {
    for params in [Params::fast(), Params::paper()] {
        watched(&params, seeds(), |problem| by_descent(problem, BarrierParams::default()));
    }
}

#[test]
fn no_step_of_the_log_barrier_by_newtons_method_intersects() {
    let mut params = Params::fast();
    params.stepper.floor = Some(1e-8);
    let ccd = AdditiveCcd { speed: ClosingSpeed::Slab, max_iterations: 50, ..AdditiveCcd::default() };
    watched(&params, seeds().div_ceil(2), |problem| by_newton(problem, BarrierParams::default(), ccd));
}

#[test]
fn no_step_to_the_earliest_impact_intersects() {
    with_impacts(EarliestImpact::new);
}

#[test]
fn no_step_to_each_vertexs_impact_intersects() {
    with_impacts(PerVertexImpact::new);
}
