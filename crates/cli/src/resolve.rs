//! `bowknot resolve`: resolves one recorded collision problem.

use crate::args::ResolveOptions;
use crate::exit::{Exit, Failure};
use crate::interrupt::Interrupt;
use crate::{failure_dump, gpu, hints, output, setup, sizes};
use bowknot::check::{CheckError, Judge, MotionJudge, PathOptions, StateOptions};
use bowknot::recording::{States, write_result};
use bowknot::run::SmallestState;
use bowknot::simulator::BackendError;
use bowknot::twoway::{AcceptedState, Observer, Params, Statistics};
use bowknot_errors::counted;
use serde::Serialize;
use std::ops::ControlFlow;
use std::panic::{self, AssertUnwindSafe};

/// Largest number of intersections that are printed, of the start or of all paths.
const MAX_LISTED: usize = 5;

/// The result, as `--json` prints it.
#[derive(Debug, Serialize)]
struct Summary {
    steps: usize,
    searches: usize,
    /// What resolved it: "cpu", or "gpu: " and the device.
    backend: String,
    /// Wall time of the call.
    seconds: f64,
    /// Processor time of all threads during the call.
    cpu_seconds: f64,
    /// RMS over free vertices of |x - y| [m].
    distance_to_target_m: f64,
    /// The same number by the name without its unit.
    distance_to_target: f64,
    remaining_m: f64,
    /// Largest distance of a prescribed vertex to its target [m].
    prescribed_lag_m: f64,
    /// Number of prescribed vertices that are not at their targets.
    prescribed_waiting: usize,
    stationarity_m: f64,
    min_gap_m: Option<f64>,
    max_step_stretch: f64,
    max_stretch: f64,
    converged: bool,
    /// Pairs that meet on the paths between accepted states; none if not checked.
    #[serde(skip_serializing_if = "Option::is_none")]
    intersections: Option<usize>,
}

pub fn resolve(options: &ResolveOptions) -> Result<Exit, Failure> {
    let interrupt = Interrupt::listen();
    let mut given = None;
    let Some(file) = &options.dump_on_failure else {
        return attempt(options, &interrupt, &mut given).map(|ended| ended.exit);
    };
    failure_dump::refuse(file, &[&options.states])?;
    if output::is_same(file, &options.out) {
        return Err(Failure::input(format!("{}: is the file of --out as well", file.display())));
    }
    let result = panic::catch_unwind(AssertUnwindSafe(|| attempt(options, &interrupt, &mut given)));
    let went_well =
        |ended: &Ended| ended.exit != Exit::CheckFailed && (ended.converged || interrupt.is_set());
    let Some((states, params)) = given.filter(|_| !matches!(&result, Ok(Ok(ended)) if went_well(ended)))
    else {
        return result.unwrap_or_else(|panic| panic::resume_unwind(panic)).map(|ended| ended.exit);
    };
    let smallest = failure_dump::reduce(&interrupt, |limits| {
        let (failure, _) = states.failure(&params, options.check, limits.stop)?;
        let reduction = states.reduce(&params, failure, limits)?;
        Some(SmallestState { failure: Some(failure), reduction })
    });
    match smallest.map(|smallest| failure_dump::write(file, &smallest, Some(&params))) {
        Some(written) => eprintln!("{}", written.unwrap_or_else(|failure| failure.message)),
        None => {
            eprintln!("the CPU does not show the failure again: nothing was written to {}", file.display())
        }
    }
    result.unwrap_or_else(|panic| panic::resume_unwind(panic)).map(|ended| ended.exit)
}

/// Judges the path to every accepted state, if asked to, and ends the call when the user does.
struct Watch<'a> {
    interrupt: &'a Interrupt,
    checker: Option<MotionJudge>,
    /// Intersections found.
    intersections: usize,
    /// Why a path could not be judged.
    unjudged: Option<CheckError>,
}

impl Watch<'_> {
    fn go_on(&self) -> ControlFlow<()> {
        if self.interrupt.is_set() || self.unjudged.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

impl Observer for Watch<'_> {
    fn accepted(&mut self, accepted: &AcceptedState<'_>) -> ControlFlow<()> {
        if let Some(judge) = &mut self.checker {
            match judge.check_path(accepted.previous, accepted.positions, &PathOptions::default()) {
                Ok(report) => {
                    let left = MAX_LISTED.saturating_sub(self.intersections);
                    let step = accepted.step;
                    report.hits.iter().take(left).for_each(|hit| eprintln!("two-way step {step}: {hit}"));
                    self.intersections += report.hit_count;
                }
                Err(error) => self.unjudged = Some(error),
            }
        }
        self.go_on()
    }

    fn sees_each_state(&self) -> bool {
        self.checker.is_some()
    }

    fn advanced(&mut self, _steps: usize) -> ControlFlow<()> {
        self.go_on()
    }
}

/// How an attempt ended that was not refused.
struct Ended {
    exit: Exit,
    converged: bool,
}

/// Resolves the problem and writes the result. `given` is the problem, once it is read.
fn attempt(
    options: &ResolveOptions,
    interrupt: &Interrupt,
    given: &mut Option<(States, Params)>,
) -> Result<Ended, Failure> {
    setup::refuse_idle_device(&options.machine, None)?;
    setup::machine(&options.machine)?;
    let mut params = bowknot::scene::twoway_params(&options.method.assignments()).map_err(Failure::input)?;
    if options.max_seconds.is_some() {
        params.solver.stop.max_seconds = options.max_seconds;
    }
    output::refuse_overwrite(&options.out, &[&options.states])?;
    output::refuse_unwritable(&options.out, "npz")?;
    let (states, params) = given.insert((States::read(&options.states)?, params));
    if states.triangles.is_empty() && states.strands.is_empty() && states.particles.is_empty() {
        eprintln!("warning: {}: no elements (F, E, P): nothing can collide", options.states.display());
    }
    let bad_input = |message: String| Failure::input(format!("{}: {message}", options.states.display()));
    for oddity in sizes::oddities(states) {
        eprintln!("warning: {}: {oddity}", options.states.display());
    }
    let model = states.collision_model().map_err(bad_input)?;
    let judge = Judge::from_model(&model);
    refuse_intersections(&judge, states).map_err(bad_input)?;

    let mut resolver =
        states.resolver(model, params.clone()).map_err(|error| bad_input(error.to_string()))?;
    let checker = options.check.then(|| MotionJudge::new(judge));
    let mut watch = Watch { interrupt, checker, intersections: 0, unjudged: None };
    let mut x = states.x.clone();
    let cpu = bowknot::simulator::cpu_seconds();
    let failure = |error: BackendError| match error {
        BackendError::Refused(error) => bad_input(error.to_string()),
        BackendError::Failed(error) => {
            Failure::backend(format!("{error}\noptions: {}", hints::of_backend(error.as_ref())))
        }
    };
    let mut backend = gpu::of_problem(&options.machine)?;
    let statistics = backend
        .prepare(resolver.scene(), &x)
        .and_then(|()| backend.resolve(&mut resolver, &mut x, &states.y, &states.input(), &mut watch))
        .map_err(&failure)?;
    backend.judge(resolver.scene(), &x).map_err(&failure)?;
    let Watch { intersections, unjudged, .. } = watch;
    if let Some(error) = unjudged {
        return Err(bad_input(error.to_string()));
    }
    let is_waiting = |v: &usize| (states.fixed[*v] || states.obstacle[*v]) && x[*v] != states.y[*v];
    // On a GPU, a vertex on the point of its grid next to the target has arrived.
    let waits = statistics.prescribed_lag_m > 0.0;
    let waiting = if waits { (0..x.len()).filter(is_waiting).count() } else { 0 };
    let mut summary = summarize(&statistics, bowknot::simulator::cpu_seconds() - cpu, waiting);
    summary.backend = backend.name();
    summary.intersections = options.check.then_some(intersections);
    write_result(&options.out, states, &x)?;

    if options.json {
        output::print_json(&summary)?;
    } else {
        output::print(&to_text(&summary, options))?;
    }
    let exit = match intersections {
        0 if interrupt.is_set() => Exit::Interrupted,
        0 => Exit::Success,
        _ => Exit::CheckFailed,
    };
    Ok(Ended { exit, converged: statistics.converged })
}

/// Refuses a start that intersects.
fn refuse_intersections(judge: &Judge, states: &States) -> Result<(), String> {
    let report = judge
        .check_state(&states.x, &StateOptions { limit: MAX_LISTED, distance: false })
        .map_err(|error| error.to_string())?;
    if report.is_clear() {
        return Ok(());
    }
    let mut lines = vec![format!(
        "array x: {} at the start",
        counted(report.intersection_count, "pair intersects", "pairs intersect")
    )];
    lines.extend(report.intersections.iter().map(|pair| format!("  {pair}")));
    let rest = report.intersection_count - report.intersections.len();
    if rest > 0 {
        lines.push(format!("  and {rest} more"));
    }
    Err(lines.join("\n"))
}

fn summarize(statistics: &Statistics, cpu_seconds: f64, prescribed_waiting: usize) -> Summary {
    Summary {
        steps: statistics.steps,
        searches: statistics.searches,
        backend: String::new(),
        seconds: statistics.seconds.total,
        cpu_seconds,
        distance_to_target_m: statistics.distance_to_target_m,
        distance_to_target: statistics.distance_to_target_m,
        remaining_m: statistics.remaining_m,
        prescribed_lag_m: statistics.prescribed_lag_m,
        prescribed_waiting,
        stationarity_m: statistics.stationarity_m,
        min_gap_m: statistics.min_gap_m,
        max_step_stretch: statistics.max_step_stretch,
        max_stretch: statistics.max_stretch,
        converged: statistics.converged,
        intersections: None,
    }
}

fn to_text(summary: &Summary, options: &ResolveOptions) -> String {
    let end = if summary.converged {
        "converged"
    } else {
        "stopped at a limit before the target, with a valid state,"
    };
    let gap =
        summary.min_gap_m.map_or_else(|| "no pair within reach".to_owned(), |gap| format!("{gap:.3e} m"));
    let lag = if summary.prescribed_lag_m > 0.0 {
        format!(
            "{}, at most {:.3e} m away: something is in the way\n",
            counted(
                summary.prescribed_waiting,
                "prescribed vertex is not at its target",
                "prescribed vertices are not at their targets"
            ),
            summary.prescribed_lag_m
        )
    } else {
        String::new()
    };
    let checked = match summary.intersections {
        None => String::new(),
        Some(0) => "checked every accepted state and path: no intersection\n".to_owned(),
        Some(count) => format!(
            "checked every accepted state and path: {}\n",
            counted(count, "INTERSECTION", "INTERSECTIONS")
        ),
    };
    format!(
        "{end} after {} and {} in {:.3} s ({:.3} s of CPU)\n\
         distance to target {:.3e} m (RMS of free vertices), not travelled {:.3e} m, stationarity {:.3e} \
         m\n{lag}\
         smallest gap {gap}, largest stretch {:.4} of the lengths at the start, {:.4} at \
         rest\n{checked}wrote {}",
        counted(summary.steps, "step", "steps"),
        counted(summary.searches, "search", "searches"),
        summary.seconds,
        summary.cpu_seconds,
        summary.distance_to_target_m,
        summary.remaining_m,
        summary.stationarity_m,
        summary.max_step_stretch,
        summary.max_stretch,
        options.out.display()
    )
}
