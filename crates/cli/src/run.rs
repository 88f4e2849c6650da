//! `bowknot run`: simulates a scene.

use crate::args::RunOptions;
use crate::exit::{Exit, Failure};
#[cfg(test)]
use crate::fault;
use crate::hints::Hint;
use crate::interrupt::Interrupt;
use crate::progress::Bar;
use crate::{bare_mesh, failure_dump, gpu, near_starts, output, setup};
use bowknot::check::{Judge, StateReport};
use bowknot::run::{FailureWatch, Outcome, Progress, Summary, residual_text};
use bowknot::scene::SimulationParams;
use bowknot::{Scene, SimulationError, Simulator, World};
use bowknot_errors::counted;
use std::ops::ControlFlow;
use std::path::Path;

/// Largest number of bodies whose sizes are printed.
const MAX_SIZES: usize = 10;

pub fn run(options: &RunOptions) -> Result<Exit, Failure> {
    setup::refuse_idle_device(&options.machine, options.dynamics_backend)?;
    setup::machine(&options.machine)?;
    // From inside of the thread pool a parallel loop is a push on a local queue; from outside each would put
    // this thread to sleep and wake it again.
    rayon::scope(|_| simulate(options))
}

/// Simulates with the threads that there are.
pub fn simulate(options: &RunOptions) -> Result<Exit, Failure> {
    if let Some(dump) = &options.dump {
        output::refuse_overwrite(dump, &[Path::new(&options.scene)])?;
    }
    if let Some(dump) = &options.dump_on_failure {
        failure_dump::refuse(dump, &[Path::new(&options.scene)])?;
    }
    let scene = open(options)?;
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(scene.name()));
    let backends = gpu::of_run(options, &scene, &out)?;
    let computed_by = backends.record();
    let interrupt = Interrupt::listen();
    let run_options = bowknot::run::RunOptions {
        out: out.clone(),
        resume: options.resume,
        check: options.check,
        interrupt: Some(interrupt.flag()),
        watch: options.dump_on_failure.is_some().then(FailureWatch::default),
    };
    let mut bar: Option<Bar> = None;
    let mut show = |progress: &Progress<'_>| {
        let bar = bar.get_or_insert_with(|| {
            if !options.quiet && !options.json {
                print_sizes(progress.world);
                near_starts::line(progress.near_starts).iter().for_each(|line| eprintln!("note: {line}"));
                computed_by.why.iter().for_each(|why| eprintln!("--backend auto: {why}"));
                let dynamics = computed_by.dynamics_why.iter();
                dynamics.for_each(|why| eprintln!("note: the CPU computes the dynamics: {why}"));
                places(&computed_by.collisions, &computed_by.dynamics)
                    .iter()
                    .for_each(|line| eprintln!("{line}"));
            }
            Bar::new(progress.frames, "frames", options.quiet)
        });
        bar.set_position(progress.step, &progress_text(progress));
        #[cfg(test)]
        fault::panic_if_asked(progress.step);
        ControlFlow::Continue(())
    };
    let result = bowknot::run::run_on(&scene, &run_options, backends, &mut show);
    if let Some(bar) = bar {
        bar.finish();
    }
    let smallest = match (&run_options.watch, &options.dump_on_failure) {
        (Some(watch), Some(file)) => dump_failure(&scene, watch, &interrupt, &result, file),
        _ => None,
    };
    let outcome = result.map_err(|error| {
        let failure = run_failure(&scene, error, options.dump.as_deref());
        let more = smallest.iter().map(|text| format!("\n{text}"));
        Failure { message: std::iter::once(failure.message).chain(more).collect(), ..failure }
    })?;

    for line in outcome.findings.iter().chain(&smallest) {
        eprintln!("{line}");
    }
    if options.json {
        output::print_json(&outcome.summary)?;
    } else if !options.quiet {
        output::print(&to_text(&outcome, &out, &scene.simulation))?;
    }
    Ok(match outcome.summary.intersections {
        Some(count) if count > 0 => Exit::CheckFailed,
        _ if outcome.interrupted => Exit::Interrupted,
        _ => Exit::Success,
    })
}

/// Writes the smallest state that shows what a run failed of, and says what it wrote; none if it did not
/// fail.
fn dump_failure(
    scene: &Scene,
    watch: &FailureWatch,
    interrupt: &Interrupt,
    result: &Result<Outcome, SimulationError>,
    file: &Path,
) -> Option<String> {
    let is_whole = |outcome: &Outcome| {
        outcome.summary.intersections.is_none_or(|count| count == 0)
            && (outcome.interrupted
                || outcome.summary.mean.as_ref().is_none_or(|mean| mean.converged == Some(1.0)))
    };
    if result.as_ref().is_ok_and(is_whole) {
        return None;
    }
    let error = result.as_ref().err();
    let smallest = failure_dump::reduce(interrupt, |limits| watch.smallest(scene, error, limits))?;
    let written = failure_dump::write(file, &smallest, Some(&scene.twoway()));
    Some(written.unwrap_or_else(|failure| failure.message))
}

/// The scene, with the options applied as assignments to its keys.
fn open(options: &RunOptions) -> Result<Scene, Failure> {
    let mut sets = Vec::new();
    if let Some(frames) = options.frames {
        sets.push(format!("simulation.frames={frames}"));
    }
    if let Some(dt) = options.dt {
        // Debug formatting keeps a whole number a float, as in 1e3.
        sets.push(format!("simulation.dt={dt:?}"));
    }
    if !options.format.is_empty() {
        let names: Vec<&str> = options.format.iter().map(|format| format.name()).collect();
        sets.push(format!("output.formats={names:?}"));
    }
    for (asked, key) in [(options.trace, "output.trace"), (options.record, "output.record")] {
        if asked {
            sets.push(format!("{key}=true"));
        }
    }
    sets.extend(options.method.assignments());
    if bare_mesh::is_mesh(&options.scene) {
        let import = bare_mesh::assignments(options.up, options.scale);
        return bare_mesh::scene(&options.scene, &[import, sets].concat());
    }
    if options.up.is_some() {
        let message = "--up applies to meshes; in a scene file, `up` is a key of each body and obstacle";
        return Err(Failure::input(message));
    }
    Scene::open(&options.scene, options.scale, &sets).map_err(|error| Failure::input(error.with_hint()))
}

/// The failure of a run. If the start intersects, writes the dump that `--dump` asks for.
fn run_failure(scene: &Scene, error: SimulationError, dump: Option<&Path>) -> Failure {
    let failure = Failure::simulation(&error);
    let (SimulationError::StartIntersects { .. }, Some(path)) = (&error, dump) else { return failure };
    match write_dump(scene, path) {
        Ok(triangles) => {
            let triangles = counted(triangles, "triangle", "triangles");
            Failure::input(format!("{error}\nwrote {triangles} to {}", path.display()))
        }
        Err(second) => Failure::input(format!("{error}\n{}", second.message)),
    }
}

/// Writes the triangles that intersect at the start, and returns their number.
fn write_dump(scene: &Scene, path: &Path) -> Result<usize, Failure> {
    let (world, report): (World, StateReport) =
        Simulator::start_intersections(scene).map_err(Failure::input)?;
    let mesh = Judge::from_model(&world.collision).offending_mesh(&world.positions, &report.intersections);
    let obstacle: Vec<bool> = mesh.vertices.iter().map(|&v| world.collision.is_obstacle(v)).collect();
    let body: Vec<u32> = mesh.vertices.iter().map(|&v| world.collision.vertex_body()[v as usize]).collect();
    crate::dump::write(path, &mesh, &obstacle, &body)?;
    Ok(mesh.triangles.len())
}

/// What runs where, unless all of it runs on the CPU.
fn places(collisions: &str, dynamics: &str) -> Option<String> {
    let is_elsewhere = [collisions, dynamics].iter().any(|name| *name != "cpu");
    is_elsewhere.then(|| format!("collisions on {collisions}, dynamics on {dynamics}"))
}

/// Prints what is simulated and how large it is.
fn print_sizes(world: &World) {
    let sizes = world.sizes();
    sizes.iter().take(MAX_SIZES).for_each(|size| eprintln!("{size}"));
    if let Some(rest) = sizes.len().checked_sub(MAX_SIZES).filter(|rest| *rest > 0) {
        eprintln!("and {rest} more");
    }
}

/// The text beside the progress bar.
fn progress_text(progress: &Progress<'_>) -> String {
    if let Some(within) = &progress.within {
        let steps = counted(within.two_way_steps, "two-way step", "two-way steps");
        let mut text = format!("step {}: {steps} in {:.0} s", progress.step + 1, within.seconds);
        if let Some(wait) = within.waits.first() {
            text += &format!(", waits for {}", wait.short());
        }
        return text;
    }
    let Some(statistics) = progress.statistics else { return String::new() };
    let mut text = counted(statistics.two_way_steps, "step", "steps");
    if let Some(gap) = statistics.min_gap_m {
        text += &format!(", gap {:.2} mm", 1e3 * gap);
    }
    if statistics.asleep_vertices > 0 {
        text += &format!(", {} asleep", counted(statistics.asleep_vertices, "vertex", "vertices"));
    }
    if statistics.residual_m > statistics.tolerance_m && !statistics.solved {
        let [residual, tolerance] = [statistics.residual_m, statistics.tolerance_m];
        text += &format!(", residual {}", residual_text(residual, tolerance));
        if let Some(unsolved) = &statistics.unsolved {
            text += &format!(", at {}", unsolved.bodies());
        }
    }
    if let (false, Some(body)) = (statistics.converged, &statistics.slowest_body) {
        text += &format!(", {body} is {:.1} mm short of its target", 1e3 * statistics.remaining_m);
    }
    if let Some(wait) = statistics.waits.first() {
        text += &format!(", waited for {}", wait.short());
    }
    if let Some(count) = progress.intersections.filter(|&count| count > 0) {
        text += &format!(", {}", counted(count, "INTERSECTION", "INTERSECTIONS"));
    }
    text
}

fn to_text(outcome: &Outcome, out: &Path, simulation: &SimulationParams) -> String {
    let frames = simulation.frames;
    let summary = &outcome.summary;
    let (mean, max) = (summary.mean.as_ref(), summary.max.as_ref());
    let mut lines = Vec::new();
    let mut line = if summary.frames > frames {
        format!(
            "{}: nothing to do, {} asked for and there are {}",
            summary.scene,
            counted(frames, "frame was", "frames were"),
            summary.frames
        )
    } else {
        let state = if outcome.interrupted { "interrupted" } else { "done" };
        format!(
            "{}: {state} after {} of {}",
            summary.scene,
            summary.frames,
            counted(frames, "frame", "frames")
        )
    };
    if let Some(seconds) = mean.and_then(|mean| mean.seconds.total) {
        line += &format!(", {seconds:.3} s per frame on {}", counted(summary.threads, "thread", "threads"));
    }
    lines.push(line);
    lines.extend(places(&summary.backend, &summary.dynamics_backend));
    let number = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
    };
    let gap =
        summary.min_gap_m.map_or_else(|| "no pair within reach".to_owned(), |gap| format!("{gap:.3e} m"));
    lines.push(format!(
        "two-way steps per frame {}, largest stretch {}, smallest gap {gap}",
        number(mean.and_then(|mean| mean.two_way_steps), 1),
        number(max.and_then(|max| max.max_stretch), 3),
    ));
    lines.extend(unreached_targets(summary));
    lines.extend(summary.held_apart_advice().map(|advice| format!("warning: {advice}")));
    lines.extend(unsolved_steps(summary, simulation));
    if let Some(slowest) = &summary.slowest_step {
        let steps = counted(slowest.two_way_steps, "two-way step", "two-way steps");
        lines.push(format!("slowest: time step {} with {steps}, which waited for", slowest.step));
        lines.extend(slowest.waits.iter().map(|wait| format!("  {wait}")));
    }
    if let Some(count) = summary.intersections {
        lines.push(match count {
            0 => "checked every accepted state and path: no intersection".to_owned(),
            _ => format!(
                "checked every accepted state and path: {}",
                counted(count, "INTERSECTION", "INTERSECTIONS")
            ),
        });
    }
    lines.push(format!("wrote {}", out.display()));
    if outcome.interrupted {
        lines.push("continue with --resume".to_owned());
    }
    lines.join("\n")
}

/// Time steps that ended unsolved, where the first of them is out of balance, and what helps.
fn unsolved_steps(summary: &Summary, simulation: &SimulationParams) -> Vec<String> {
    let Some(advice) = summary.unsolved_advice(simulation) else { return Vec::new() };
    let mut lines = vec![format!("warning: {}", advice.text)];
    if let Some(remedy) = advice.remedy {
        let option = |key: &str, value: &str| match key {
            "newton_iterations" => format!("--set simulation.newton_iterations={value}"),
            _ => format!("--{key} {value}").trim_end().to_owned(),
        };
        lines.push(format!("  what helps: {}", remedy.in_words(option)));
    }
    lines
}

/// Time steps that ended at a limit, and obstacles and pins with something in their way or place.
fn unreached_targets(summary: &Summary) -> Vec<String> {
    let mut lines = Vec::new();
    let converged = summary.mean.as_ref().and_then(|mean| mean.converged).unwrap_or(1.0);
    let stopped = ((1.0 - converged) * summary.frames as f64).round() as usize;
    if stopped > 0 {
        let stopped = counted(stopped, "time step", "time steps");
        lines.push(format!("{stopped} ended at the limit of steps or time, short of the target"));
    }
    for (name, lag) in summary.max.iter().flat_map(|max| &max.waiting) {
        let lag = lag.unwrap_or(f64::NAN);
        lines.push(format!(
            "{name} was held up by what was in its way, or by the limit of steps: at most {lag:.3e} m behind \
             its motion"
        ));
    }
    for (name, wait) in &summary.waits_to_appear {
        let steps = counted(wait.steps, "time step", "time steps");
        lines.push(format!("obstacle {name} waited {steps} to appear: {}", wait.in_the_way));
    }
    lines
}
