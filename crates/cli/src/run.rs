//! `bowknot run`: simulate a scene.

use crate::args::{Method, Preset, RunOptions};
use crate::failure::{Done, Failure};
use crate::interrupt::Interrupt;
use crate::progress::Bar;
use crate::{loose, output, setup};
use bowknot::check::{Judge, StateReport};
use bowknot::run::{Outcome, Progress, Summary};
use bowknot::{Scene, SimulationError, Simulator, World};
use std::ops::ControlFlow;
use std::path::Path;

pub fn run(options: &RunOptions) -> Result<Done, Failure> {
    setup::machine(&options.machine)?;
    let scene = open(options)?;
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(scene.name()));
    let interrupt = Interrupt::listen();
    let run_options = bowknot::run::RunOptions {
        out: out.clone(),
        resume: options.resume,
        check: options.check,
        interrupt: Some(interrupt.flag()),
    };
    let mut bar: Option<Bar> = None;
    let mut show = |progress: &Progress<'_>| {
        let bar = bar.get_or_insert_with(|| Bar::new(progress.frames, "frames", options.quiet));
        bar.at(progress.step, &notable(progress));
        ControlFlow::Continue(())
    };
    let result = bowknot::run::run(&scene, &run_options, &mut show);
    if let Some(bar) = bar {
        bar.finish();
    }
    let outcome = result.map_err(|error| refused(&scene, error, options.dump.as_deref()))?;

    for finding in &outcome.findings {
        eprintln!("{finding}");
    }
    if options.json {
        output::print_json(&outcome.summary)?;
    } else if !options.quiet {
        output::print(&in_words(&outcome, &out, scene.simulation.frames))?;
    }
    Ok(match outcome.summary.intersections {
        Some(count) if count > 0 => Done::Found,
        _ if outcome.interrupted => Done::Interrupted,
        _ => Done::Fine,
    })
}

/// The scene, with the options applied as assignments to its keys.
fn open(options: &RunOptions) -> Result<Scene, Failure> {
    let mut sets = Vec::new();
    if let Some(frames) = options.frames {
        sets.push(format!("simulation.frames={frames}"));
    }
    if let Some(dt) = options.dt {
        // A float also where it is whole, as in 1e3.
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
    sets.extend(method_sets(&options.method));
    if loose::is_mesh(&options.scene) {
        if options.scale.is_some() {
            let message =
                "--scale applies to built-in scenes; for a mesh in other units: --set body.0.scale=0.001";
            return Err(Failure::input(message));
        }
        return loose::scene(&options.scene, &sets);
    }
    Scene::open(&options.scene, options.scale, &sets).map_err(Failure::input)
}

/// The method's options as assignments to keys of a scene; `--set` comes last and wins.
pub fn method_sets(method: &Method) -> Vec<String> {
    let preset = method.preset.map(|preset| match preset {
        Preset::Fast => "contact.preset=\"fast\"".to_owned(),
        Preset::Paper => "contact.preset=\"paper\"".to_owned(),
    });
    preset.into_iter().chain(method.sets.iter().cloned()).collect()
}

/// The message of a run that did not begin or could not go on; writes the dump if one is asked for.
fn refused(scene: &Scene, error: SimulationError, dump: Option<&Path>) -> Failure {
    let failure = Failure::input(&error);
    let (SimulationError::StartIntersects { .. }, Some(path)) = (&error, dump) else { return failure };
    match write_dump(scene, path) {
        Ok(triangles) => {
            Failure::input(format!("{error}\nwrote {triangles} triangles to {}", path.display()))
        }
        Err(second) => Failure::input(format!("{error}\n{}", second.message)),
    }
}

/// Writes the triangles that intersect at the start. Returns how many.
fn write_dump(scene: &Scene, path: &Path) -> Result<usize, Failure> {
    let (world, report): (World, StateReport) =
        Simulator::start_intersections(scene).map_err(Failure::input)?;
    let mesh = Judge::from_model(&world.collision).offending_mesh(&world.positions, &report.intersections);
    let obstacle: Vec<bool> = mesh.vertices.iter().map(|&v| world.collision.is_obstacle(v)).collect();
    let body: Vec<u32> = mesh.vertices.iter().map(|&v| world.collision.vertex_body()[v as usize]).collect();
    crate::dump::write(path, &mesh, &obstacle, &body)?;
    Ok(mesh.triangles.len())
}

/// What is worth a look while a run goes on.
fn notable(progress: &Progress<'_>) -> String {
    let Some(statistics) = progress.statistics else { return String::new() };
    let mut text = format!("{} steps", statistics.two_way_steps);
    if let Some(gap) = statistics.min_gap_m {
        text += &format!(", gap {:.2} mm", 1e3 * gap);
    }
    if let (false, Some(body)) = (statistics.converged, &statistics.slowest_body) {
        text += &format!(", {body} waits with {:.1} mm to go", 1e3 * statistics.remaining_m);
    }
    if let Some(count) = progress.intersections.filter(|&count| count > 0) {
        text += &format!(", {count} INTERSECTIONS");
    }
    text
}

fn in_words(outcome: &Outcome, out: &Path, frames: usize) -> String {
    let summary = &outcome.summary;
    let mean = |path: &str| summary.mean.pointer(path).and_then(serde_json::Value::as_f64);
    let mut lines = Vec::new();
    let state = if outcome.interrupted { "interrupted" } else { "done" };
    let mut line = format!("{}: {state} after {} of {frames} frames", summary.scene, summary.frames);
    if let Some(seconds) = mean("/seconds/total") {
        line += &format!(", {:.3} s a frame on {} threads", seconds, summary.threads);
    }
    lines.push(line);
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.1}"));
    let gap = summary.min_gap_m.map_or_else(|| "none in reach".to_owned(), |gap| format!("{gap:.3e} m"));
    lines.push(format!(
        "two-way steps a frame {}, largest stretch {}, smallest gap {gap}",
        number(mean("/two_way_steps")),
        summary
            .max
            .pointer("/max_stretch")
            .and_then(serde_json::Value::as_f64)
            .map_or_else(|| "-".to_owned(), |s| format!("{s:.3}")),
    ));
    lines.extend(unfinished(summary));
    if let Some(count) = summary.intersections {
        lines.push(match count {
            0 => "checked every accepted state and path: no intersection".to_owned(),
            _ => format!("checked every accepted state and path: {count} INTERSECTIONS"),
        });
    }
    lines.push(format!("wrote {}", out.display()));
    if outcome.interrupted {
        lines.push("continue with --resume".to_owned());
    }
    lines.join("\n")
}

/// What did not get where it was to be: time steps that ended at a limit, obstacles and pins with something in their way.
fn unfinished(summary: &Summary) -> Vec<String> {
    let mut lines = Vec::new();
    let arrived = summary.mean.pointer("/converged").and_then(serde_json::Value::as_f64).unwrap_or(1.0);
    let stopped = ((1.0 - arrived) * summary.frames as f64).round();
    if stopped > 0.0 {
        lines.push(format!(
            "{stopped} time steps ended at the limit of steps or time, short of their targets"
        ));
    }
    let waiting = summary.max.pointer("/waiting").and_then(serde_json::Value::as_object);
    for (name, behind) in waiting.into_iter().flatten() {
        let behind = behind.as_f64().unwrap_or(f64::NAN);
        lines
            .push(format!("{name} waited for what was in its way, {behind:.3e} m behind its motion at most"));
    }
    lines
}
