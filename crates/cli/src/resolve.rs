//! `bowknot resolve`: one collision problem from a file to a file.

use crate::args::ResolveOptions;
use crate::failure::{Done, Failure};
use crate::interrupt::Interrupt;
use crate::run::method_sets;
use crate::{output, setup};
use bowknot::check::{Judge, StateOptions};
use bowknot::geometry::Topology;
use bowknot::io::{States, write_result};
use bowknot::proximity::{BodyFilter, CollisionModel};
use bowknot::twoway::{AcceptedState, Call, Resolver, Statistics};
use serde::Serialize;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Intersections of a refused start that are written out.
const LISTED: usize = 5;

/// What `--json` prints.
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

pub fn resolve(options: &ResolveOptions) -> Result<Done, Failure> {
    setup::machine(&options.machine)?;
    let mut params = bowknot::scene::twoway_params(&method_sets(&options.method)).map_err(Failure::input)?;
    if options.max_seconds.is_some() {
        params.stop.max_seconds = options.max_seconds;
    }
    let states = States::read(&options.states)?;
    let fault = |message: String| Failure::input(format!("{}: {message}", options.states.display()));
    let model = model(&states).map_err(fault)?;
    refuse_intersections(&model, &states).map_err(fault)?;

    let mut resolver = Resolver::new(model, &states.rest, &states.masses, params)
        .map_err(|error| fault(error.to_string()))?;
    let interrupt = Interrupt::listen();
    let mut watch = |_: &AcceptedState<'_>| {
        if interrupt.is_set() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let call = Call { prescribed: &states.fixed, time_step: states.time_step, ..Call::default() };
    let mut x = states.x.clone();
    let cpu = bowknot::simulator::cpu_seconds();
    let statistics =
        resolver.resolve(&mut x, &states.y, &call, &mut watch).map_err(|error| fault(error.to_string()))?;
    let summary = summarise(&statistics, bowknot::simulator::cpu_seconds() - cpu);
    write_result(&options.out, &x)?;

    if options.json {
        output::print_json(&summary)?;
    } else {
        output::print(&in_words(&summary, options))?;
    }
    Ok(if interrupt.is_set() { Done::Interrupted } else { Done::Fine })
}

/// The collision model of a problem: a body is an obstacle if all its vertices are.
fn model(states: &States) -> Result<CollisionModel, String> {
    let topology =
        Topology::new(states.x.len(), states.triangles.clone(), &states.strands, &states.particles)
            .map_err(|errors| first_of(&errors))?;
    let mut obstacle: BTreeMap<u32, bool> = BTreeMap::new();
    for (vertex, (&body, &flag)) in states.body.iter().zip(&states.obstacle).enumerate() {
        if *obstacle.entry(body).or_insert(flag) != flag {
            return Err(format!(
                "array O: body {body} has obstacle and deformable vertices (vertex {vertex} differs from its first)"
            ));
        }
    }
    let count = obstacle.keys().next_back().map_or(0, |&body| body as usize + 1);
    let filter = |body: u32| match obstacle.get(&body) {
        Some(true) => BodyFilter::OBSTACLE,
        _ => BodyFilter::DEFORMABLE,
    };
    let filters = (0..count as u32).map(filter).collect();
    CollisionModel::new(topology, states.body.clone(), filters, states.half_spaces.clone())
        .map_err(|error| error.to_string())
}

fn first_of(errors: &[impl ToString]) -> String {
    let first = errors.first().map(ToString::to_string).unwrap_or_default();
    if errors.len() > 1 { format!("{first}; and {} more", errors.len() - 1) } else { first }
}

fn refuse_intersections(model: &CollisionModel, states: &States) -> Result<(), String> {
    let report = Judge::from_model(model)
        .check_state(&states.x, &StateOptions { limit: LISTED, distance: false })
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

fn summarise(statistics: &Statistics, cpu_seconds: f64) -> Summary {
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

fn in_words(summary: &Summary, options: &ResolveOptions) -> String {
    let end = if summary.converged { "converged" } else { "stopped early, with a valid state" };
    let gap = summary.min_gap_m.map_or_else(|| "none in reach".to_owned(), |gap| format!("{gap:.3e} m"));
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
