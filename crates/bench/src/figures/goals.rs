//! The goals of the project, and the present figures.

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::memory::{Footprint, footprint};
use crate::methods::Setting;
use crate::simulate::{Simulation, run};
use crate::solve::Against;
use crate::summary::{Compared, Summary, on_scenes};
use crate::table::{Entry, Table, median, short};
use anyhow::Result;
use bowknot::Scene;

pub struct Goals;

/// A figure to reach, and its present value.
struct Goal {
    what: String,
    measured: f64,
    /// The smallest value that meets the goal; the largest, if smaller is better.
    required: f64,
    /// The value that was aimed at; it is better than `required`.
    aim: f64,
    unit: &'static str,
}

/// Ratios of other methods to `fast` in a scene: required, and aimed at.
struct RatioGoals {
    scene: &'static str,
    steps_of_paper: [f64; 2],
    time_of_paper: [f64; 2],
    time_of_barrier: [f64; 2],
}

const PRESETS: [RatioGoals; 3] = [
    RatioGoals {
        scene: "needle-unaware",
        steps_of_paper: [15.0, 60.0],
        time_of_paper: [8.0, 20.0],
        time_of_barrier: [5.0, 25.0],
    },
    RatioGoals {
        scene: "stack-unaware",
        steps_of_paper: [12.0, 20.0],
        time_of_paper: [8.0, 20.0],
        time_of_barrier: [12.0, 25.0],
    },
    RatioGoals {
        scene: "tube-unaware",
        steps_of_paper: [8.0, 11.0],
        time_of_paper: [8.0, 20.0],
        time_of_barrier: [12.0, 25.0],
    },
];

/// Seconds per time step of the paper's collision stage, on its GPU (Table 2).
const KNOTS: [(&str, f64); 2] = [("bow-knot", 0.034), ("reef-knot", 0.024)];

impl Figure for Goals {
    fn name(&self) -> &'static str {
        "goals"
    }

    fn title(&self) -> &'static str {
        "Goals of the project"
    }

    fn question(&self) -> &'static str {
        "`fast` against `paper` and the log barrier on recorded problems with contact-unaware targets: \
         ratios of the mean steps and of the mean CPU seconds of two problems, at most 4 s per solve. \
         `sphere` at scale 1, 50,176 vertices: one thread against two, medians of time steps in contact, and \
         the share of the collision stage in flight. Knots at the paper's size: wall seconds of the \
         collision stage on two threads, as multiples of the paper's on a GPU. Memory: peak of a run less \
         that of a very small run, dynamics included, per surface vertex. The proximity search is compared \
         with the IPC Toolkit's in the section on peers."
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut goals = presets(bench)?;
        goals.extend(sphere(bench)?);
        goals.extend(knots(bench)?);
        goals.extend(memory(bench)?);
        let met = goals.iter().filter(|g| g.is_met(g.required)).count();
        let reached = goals.iter().filter(|g| g.is_met(g.aim)).count();
        let mut table = Table::new(["goal", "measured", "required", "aim", "verdict"]);
        goals.iter().for_each(|goal| table.row(goal.row()));
        Ok(Report {
            finding: format!("{met} of {} goals are met, {reached} of them reach the aim.", goals.len()),
            parts: vec![Part::table(self.name(), "", table)],
        })
    }
}

impl Goal {
    /// Whether the measured value is at least as good as `value`; the aim tells whether larger or smaller is
    /// better.
    fn is_met(&self, value: f64) -> bool {
        if self.aim >= self.required { self.measured >= value } else { self.measured <= value }
    }

    fn row(&self) -> Vec<Entry> {
        let verdict = match (self.is_met(self.required), self.is_met(self.aim)) {
            (_, true) => "aim reached",
            (true, _) => "met",
            _ => "missed",
        };
        let text = |value: f64| Entry::from(format!("{}{}", short(value), self.unit));
        vec![
            self.what.as_str().into(),
            text(self.measured),
            text(self.required),
            text(self.aim),
            verdict.into(),
        ]
    }
}

fn presets(bench: &Bench) -> Result<Vec<Goal>> {
    let scenes: Vec<&'static str> = PRESETS.iter().map(|goals| goals.scene).collect();
    let scenes = bench.size.pick(&scenes[..], &scenes[..2], &scenes[..1]);
    let methods = ["fast", "paper", "log barrier"];
    let settings = methods.iter().map(|m| Setting::of(m)).collect::<Result<Vec<_>>>()?;
    let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Residuals)?;
    let mut goals = Vec::new();
    for RatioGoals { scene, steps_of_paper, time_of_paper, time_of_barrier } in PRESETS {
        let Some(c) = compared.iter().find(|c: &&Compared| c.scene == scene) else { continue };
        let ratio = |method: &str, value: fn(&Summary) -> f64| {
            Some(value(c.find(method, "")?) / value(c.find("fast", "")?))
        };
        let all = [
            ("steps of `paper` over those of `fast`", ratio("paper", |s| s.steps), steps_of_paper),
            ("CPU time of `paper` over that of `fast`", ratio("paper", |s| s.cpu), time_of_paper),
            (
                "CPU time of the log barrier over that of `fast`",
                ratio("log barrier", |s| s.cpu),
                time_of_barrier,
            ),
        ];
        goals.extend(all.into_iter().filter_map(|(what, measured, [required, aim])| {
            Some(Goal { what: format!("{scene}: {what}"), measured: measured?, required, aim, unit: "x" })
        }));
    }
    Ok(goals)
}

/// A run on that many threads, whatever `--threads` says.
fn timed(bench: &Bench, scene: &str, scale: f64, frames: usize, threads: usize) -> Result<Simulation> {
    let key = format!("goals/{scene}-{scale}-{frames}-{threads}");
    bench.store.measured(&key, || {
        let scene = Scene::builtin(scene, scale)?;
        rayon::ThreadPoolBuilder::new().num_threads(threads).build()?.install(|| run(&scene, frames, 1))
    })
}

fn sphere(bench: &Bench) -> Result<Vec<Goal>> {
    if !bench.has_time() {
        return Ok(Vec::new());
    }
    let scale = bench.size.pick(1.0, 0.4, 0.2);
    let [one, two] = [timed(bench, "sphere", scale, 20, 1)?, timed(bench, "sphere", scale, 20, 2)?];
    let whole = |s: &Simulation, k: usize| s.collision[k] + s.dynamics[k];
    let steps = |contact: bool| {
        // The first time step allocates buffers.
        (1..one.steps.len()).filter(|&k| (one.contact_rows[k] > 0) == contact).collect::<Vec<usize>>()
    };
    let ratios: Vec<f64> = steps(true).iter().map(|&k| whole(&one, k) / whole(&two, k)).collect();
    let shares: Vec<f64> = steps(false).iter().map(|&k| one.collision[k] / whole(&one, k)).collect();
    let what = "measured: one thread's wall time over that of two, in contact".to_owned();
    let share = "measured: share of the collision stage in flight".to_owned();
    Ok(vec![
        Goal { what, measured: median(&ratios), required: 1.6, aim: 1.9, unit: "x" },
        Goal { what: share, measured: 100.0 * median(&shares), required: 10.0, aim: 2.0, unit: " %" },
    ])
}

fn knots(bench: &Bench) -> Result<Vec<Goal>> {
    let mut goals = Vec::new();
    for (scene, paper) in KNOTS {
        if !bench.has_time() {
            break;
        }
        let frames = bench.size.pick(30, 10, 2);
        let done = timed(bench, scene, bench.size.pick(1.0, 0.2, 0.1), frames, 2)?;
        let seconds = done.collision.iter().sum::<f64>() / frames as f64;
        goals.push(Goal {
            what: format!("{scene}: collision seconds over the paper's, first {frames} time steps"),
            measured: seconds / paper,
            required: 10.0,
            aim: 3.0,
            unit: "x",
        });
    }
    Ok(goals)
}

fn memory(bench: &Bench) -> Result<Vec<Goal>> {
    let scale = bench.size.pick(1.0, 0.4, 0.2);
    let of = |scene: &str, scale: f64, frames: usize| -> Result<Footprint> {
        bench.store.measured(&format!("goals/memory-{scene}-{scale}"), || footprint(scene, scale, frames))
    };
    let nothing = of("drape", 0.05, 1)?;
    let mut goals = Vec::new();
    for (scene, frames) in [("needle", 12), ("stack", 60), ("sphere", 16)] {
        if !bench.has_time() {
            break;
        }
        let found = of(scene, scale, frames)?;
        let each = found.bytes.saturating_sub(nothing.bytes) as f64 / found.vertices as f64;
        let pairs = found.pairs as f64 / found.vertices as f64;
        goals.push(Goal {
            what: format!("{scene}: memory per vertex, at {} candidate pairs per vertex", short(pairs)),
            measured: 1e-3 * each,
            required: 3.0,
            aim: 1.5,
            unit: " kB",
        });
    }
    Ok(goals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn larger_or_smaller_is_better() {
        let goal = |measured, required, aim| Goal { what: String::new(), measured, required, aim, unit: "" };
        let verdict = |goal: &Goal| (goal.is_met(goal.required), goal.is_met(goal.aim));
        assert_eq!(verdict(&goal(2.0, 1.5, 3.0)), (true, false));
        assert_eq!(verdict(&goal(2.0, 10.0, 3.0)), (true, true));
        assert_eq!(verdict(&goal(4.0, 3.0, 1.5)), (false, false));
    }
}
