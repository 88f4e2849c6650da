//! `bowknot resolve`: resolves one recorded collision problem.

use crate::args::ResolveOptions;
use crate::exit::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{output, setup};
use bowknot::check::{Judge, StateOptions};
use bowknot::proximity::CollisionModel;
use bowknot::recording::{States, write_result};
use bowknot::twoway::{AcceptedState, Statistics};
use serde::Serialize;
use std::ops::ControlFlow;

/// Largest number of intersections that are printed when the start is refused.
const MAX_LISTED: usize = 5;

/// The result, as `--json` prints it.
#[derive(Debug, Serialize)]
struct Summary {
    steps: usize,
    searches: usize,
    /// Wall time of the call.
    seconds: f64,
    /// Processor time of all threads during the call.
    cpu_seconds: f64,
    /// RMS over free vertices of |x - y| [m].
    distance_to_target: f64,
    remaining_m: f64,
    stationarity_m: f64,
    min_gap_m: Option<f64>,
    max_step_stretch: f64,
    converged: bool,
}

pub fn resolve(options: &ResolveOptions) -> Result<Exit, Failure> {
    setup::machine(&options.machine)?;
    let mut params = bowknot::scene::twoway_params(&options.method.assignments()).map_err(Failure::input)?;
    if options.max_seconds.is_some() {
        params.solver.stop.max_seconds = options.max_seconds;
    }
    let states = States::read(&options.states)?;
    let bad_input = |message: String| Failure::input(format!("{}: {message}", options.states.display()));
    let model = states.collision_model().map_err(bad_input)?;
    refuse_intersections(&model, &states).map_err(bad_input)?;

    let mut resolver = states.resolver(model, params).map_err(|error| bad_input(error.to_string()))?;
    let interrupt = Interrupt::listen();
    let mut watch = |_: &AcceptedState<'_>| {
        if interrupt.is_set() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut x = states.x.clone();
    let cpu = bowknot::simulator::cpu_seconds();
    let statistics = resolver
        .resolve_with(&mut x, &states.y, &states.input(), &mut watch)
        .map_err(|error| bad_input(error.to_string()))?;
    let summary = summarize(&statistics, bowknot::simulator::cpu_seconds() - cpu);
    write_result(&options.out, &x)?;

    if options.json {
        output::print_json(&summary)?;
    } else {
        output::print(&to_text(&summary, options))?;
    }
    Ok(if interrupt.is_set() { Exit::Interrupted } else { Exit::Success })
}

/// Refuses a start that intersects.
fn refuse_intersections(model: &CollisionModel, states: &States) -> Result<(), String> {
    let report = Judge::from_model(model)
        .check_state(&states.x, &StateOptions { limit: MAX_LISTED, distance: false })
        .map_err(|error| error.to_string())?;
    if report.is_clear() {
        return Ok(());
    }
    let mut lines = vec![format!("array x: {} pairs intersect at the start", report.intersection_count)];
    lines.extend(report.intersections.iter().map(|pair| format!("  {pair}")));
    let rest = report.intersection_count - report.intersections.len();
    if rest > 0 {
        lines.push(format!("  and {rest} more"));
    }
    Err(lines.join("\n"))
}

fn summarize(statistics: &Statistics, cpu_seconds: f64) -> Summary {
    Summary {
        steps: statistics.steps,
        searches: statistics.searches,
        seconds: statistics.seconds.total,
        cpu_seconds,
        distance_to_target: statistics.distance_to_target_m,
        remaining_m: statistics.remaining_m,
        stationarity_m: statistics.stationarity_m,
        min_gap_m: statistics.min_gap_m,
        max_step_stretch: statistics.max_step_stretch,
        converged: statistics.converged,
    }
}

fn to_text(summary: &Summary, options: &ResolveOptions) -> String {
    let end = if summary.converged { "converged" } else { "stopped early, with a valid state" };
    let gap =
        summary.min_gap_m.map_or_else(|| "no pair within reach".to_owned(), |gap| format!("{gap:.3e} m"));
    format!(
        "{end} after {} steps and {} searches in {:.3} s ({:.3} s of CPU)\n\
         distance to target {:.3e} m (RMS), not travelled {:.3e} m, stationarity {:.3e} m\n\
         smallest gap {gap}, largest stretch in the call {:.4}\nwrote {}",
        summary.steps,
        summary.searches,
        summary.seconds,
        summary.cpu_seconds,
        summary.distance_to_target,
        summary.remaining_m,
        summary.stationarity_m,
        summary.max_step_stretch,
        options.out.display()
    )
}
