//! What the project set out to reach, and where it stands.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::memory::{Footprint, footprint};
use crate::methods::Setting;
use crate::simulate::{Simulation, run};
use crate::solve::Against;
use crate::summary::{Compared, Summary, on_scenes};
use crate::table::{Entry, Table, median, short};
use anyhow::Result;
use bowknot::Scene;

pub struct Goals;

/// A figure to reach.
struct Goal {
    what: String,
    here: f64,
    /// What it has to be at least (at most, if smaller is better), and what was aimed at.
    least: f64,
    aim: f64,
    unit: &'static str,
}

/// How many times those of `fast` others should take in a scene: at least, and as aimed at.
struct Over {
    scene: &'static str,
    steps_of_paper: [f64; 2],
    time_of_paper: [f64; 2],
    time_of_barrier: [f64; 2],
}

const PRESETS: [Over; 3] = [
    Over {
        scene: "needle-blind",
        steps_of_paper: [15.0, 60.0],
        time_of_paper: [8.0, 20.0],
        time_of_barrier: [5.0, 25.0],
    },
    Over {
        scene: "stack-blind",
        steps_of_paper: [12.0, 20.0],
        time_of_paper: [8.0, 20.0],
        time_of_barrier: [12.0, 25.0],
    },
    Over {
        scene: "tube-blind",
        steps_of_paper: [8.0, 11.0],
        time_of_paper: [8.0, 20.0],
        time_of_barrier: [12.0, 25.0],
    },
];

/// Seconds of the paper's collision stage a time step, on its GPU (Table 2).
const KNOTS: [(&str, f64); 2] = [("bow-knot", 0.034), ("reef-knot", 0.024)];

impl Figure for Goals {
    fn name(&self) -> &'static str {
        "goals"
    }

    fn title(&self) -> &'static str {
        "What the project set out to reach"
    }

    fn question(&self) -> &'static str {
        "`fast` against `paper` and the log barrier on recorded problems with targets of a dynamics blind to contact: ratios of \
         mean steps and mean CPU seconds of two problems, a solve ending after 4 s. `sphere` at scale 1, 50,176 vertices: two threads \
         against one, medians of time steps in contact, and the share of the collision stage in flight. Knots at the paper's size: \
         wall seconds of the collision stage on two threads, as multiples of the paper's on a GPU. Memory: largest resident set of a \
         run less that of a run of next to nothing, dynamics included, for each surface vertex. Proximity search \
         against the IPC Toolkit is among the peers, at the end of this page."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let mut goals = presets(bench)?;
        goals.extend(sphere(bench)?);
        goals.extend(knots(bench)?);
        goals.extend(memory(bench)?);
        let met = goals.iter().filter(|g| g.is_met(g.least)).count();
        let reached = goals.iter().filter(|g| g.is_met(g.aim)).count();
        let missed: Vec<&str> =
            goals.iter().filter(|g| !g.is_met(g.least)).map(|g| g.what.as_str()).collect();
        let missed = if missed.is_empty() { "none".to_owned() } else { missed.join("; ") };
        let mut table = Table::new(["what", "here", "at least", "aim", ""]);
        goals.iter().for_each(|goal| table.row(goal.row()));
        Ok(Section {
            finding: format!(
                "{met} of {} are met, {reached} of them as aimed at. Missed: {missed}.",
                goals.len()
            ),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}

impl Goal {
    /// Whether it is as good as `value`; the aim lies on the good side.
    fn is_met(&self, value: f64) -> bool {
        if self.aim >= self.least { self.here >= value } else { self.here <= value }
    }

    fn row(&self) -> Vec<Entry> {
        let verdict = match (self.is_met(self.least), self.is_met(self.aim)) {
            (_, true) => "as aimed at",
            (true, _) => "met",
            _ => "missed",
        };
        let told = |value: f64| Entry::from(format!("{}{}", short(value), self.unit));
        vec![self.what.as_str().into(), told(self.here), told(self.least), told(self.aim), verdict.into()]
    }
}

fn presets(bench: &Bench) -> Result<Vec<Goal>> {
    let scenes: Vec<&'static str> = PRESETS.iter().map(|over| over.scene).collect();
    let scenes = bench.size.pick(&scenes[..], &scenes[..2], &scenes[..1]);
    let methods = ["fast", "paper", "log barrier"];
    let settings = methods.iter().map(|m| Setting::of(m)).collect::<Result<Vec<_>>>()?;
    let compared = on_scenes(bench, scenes, bench.size.pick(2, 1, 1), &settings, 1, Against::Residuals)?;
    let mut goals = Vec::new();
    for Over { scene, steps_of_paper, time_of_paper, time_of_barrier } in PRESETS {
        let Some(c) = compared.iter().find(|c: &&Compared| c.scene == scene) else { continue };
        let over = |method: &str, value: fn(&Summary) -> f64| {
            Some(value(c.find(method, "")?) / value(c.find("fast", "")?))
        };
        let all = [
            ("steps of `paper` over those of `fast`", over("paper", |s| s.steps), steps_of_paper),
            ("CPU time of `paper` over that of `fast`", over("paper", |s| s.cpu), time_of_paper),
            (
                "CPU time of the log barrier over that of `fast`",
                over("log barrier", |s| s.cpu),
                time_of_barrier,
            ),
        ];
        goals.extend(all.into_iter().filter_map(|(what, here, [least, aim])| {
            Some(Goal { what: format!("{scene}: {what}"), here: here?, least, aim, unit: "x" })
        }));
    }
    Ok(goals)
}

/// A run by that many threads, whatever the command was given.
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
        // The first time step sets up its buffers.
        (1..one.steps.len()).filter(|&k| (one.contact_rows[k] > 0) == contact).collect::<Vec<usize>>()
    };
    let ratios: Vec<f64> = steps(true).iter().map(|&k| whole(&one, k) / whole(&two, k)).collect();
    let shares: Vec<f64> = steps(false).iter().map(|&k| one.collision[k] / whole(&one, k)).collect();
    let what = "sphere: one thread's wall time over that of two, in contact".to_owned();
    let share = "sphere: share of the collision stage in flight".to_owned();
    Ok(vec![
        Goal { what, here: median(&ratios), least: 1.6, aim: 1.9, unit: "x" },
        Goal { what: share, here: 100.0 * median(&shares), least: 10.0, aim: 2.0, unit: " %" },
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
            here: seconds / paper,
            least: 10.0,
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
            what: format!("{scene}: memory a vertex, {} pairs a vertex listed", short(pairs)),
            here: 1e-3 * each,
            least: 3.0,
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
    fn a_goal_is_met_on_its_good_side() {
        let goal = |here, least, aim| Goal { what: String::new(), here, least, aim, unit: "" };
        let verdict = |goal: &Goal| (goal.is_met(goal.least), goal.is_met(goal.aim));
        assert_eq!(verdict(&goal(2.0, 1.5, 3.0)), (true, false));
        assert_eq!(verdict(&goal(2.0, 10.0, 3.0)), (true, true));
        assert_eq!(verdict(&goal(4.0, 3.0, 1.5)), (false, false));
    }
}
