//! The goals of the project, and the present figures.

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::process::{Case, ProcessRun, TimeStep};
use crate::table::{Entry, Table, geometric_mean, largest, mean, short};
use anyhow::{Context, Result};
use bowknot::simulator::StepSeconds;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

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

/// A row of the paper's Table 2 at the paper's size: the scene, the number of its first time steps, and
/// seconds per time step of the paper's collision stage, on its GPU.
pub(super) const TABLE_2: [(&str, usize, f64); 12] = [
    ("needle", 8, 0.036),
    ("blade", 2, 0.267),
    ("funnel", 2, 0.087),
    ("sphere", 18, 0.044),
    ("dress", 6, 0.133),
    ("gown", 6, 0.092),
    ("bow-knot", 12, 0.034),
    ("reef-knot", 12, 0.024),
    ("tube", 8, 0.308),
    ("mat", 8, 0.020),
    ("hair", 10, 0.252),
    ("sand", 40, 0.223),
];

/// Scenes in which the time of the dynamics is compared, beside those of [`TABLE_2`] of the same name.
const DYNAMICS: [&str; 3] = ["drape", "dress", "mat"];

/// Scales of `drape` for the growth of the time with the number of vertices; the number grows with the
/// square.
const SCALES: [f64; 4] = [0.64, 1.28, 2.56, 5.12];

/// Time steps of `drape` for that growth; it touches the ball in the last ones.
const GROWTH_FRAMES: usize = 16;

impl Figure for Goals {
    fn name(&self) -> &'static str {
        "goals"
    }

    fn title(&self) -> &'static str {
        "Goals of the project"
    }

    fn question(&self) -> &'static str {
        "First time steps of the scenes of Table 2 at the paper's size, see `goals-table-2.csv`: seconds of \
         the collision stage on two threads as multiples of the paper's on a GPU, two-way steps per time \
         step, all its collision problems together, and peak memory of the process per vertex. With \
         `--before BOWKNOT`, a program of an older commit: its time with one thread over the present one, \
         geometric mean for the collision stage. Stages: the whole time step and the worst one, see \
         `goals-stages.csv`. `drape`: growth of the time per time step with the number of vertices, as the \
         exponent of a fitted power, over the time steps in contact."
    }

    fn on_page(&self) -> bool {
        true
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let runs = Runs { bench };
        let mut table = Table::new([
            "scene",
            "time_steps",
            "in_contact",
            "vertices",
            "collision_s",
            "collision_before",
            "dynamics_s",
            "dynamics_before",
            "collision_s_2_threads",
            "paper_gpu_collision_s",
            "steps",
            "most_steps",
            "kb_per_vertex",
        ]);
        let mut goals = table_2(&runs, &mut table)?;
        goals.extend(dynamics(&runs)?);
        let mut stages = Table::new(["stage", "drape_growth", "sphere_one_thread_over_two"]);
        goals.extend(stage_goals(&runs, &mut stages)?);
        goals.extend(flight(&runs)?);
        goals.extend(few_vertices(&runs)?);
        // Small runs lack time steps in contact.
        goals.retain(|goal| goal.measured.is_finite());
        let met = goals.iter().filter(|g| g.is_met(g.required)).count();
        let reached = goals.iter().filter(|g| g.is_met(g.aim)).count();
        let mut page = Table::new(["goal", "measured", "required", "aim", "verdict"]);
        goals.iter().for_each(|goal| page.row(goal.row()));
        Ok(Report {
            finding: format!("{met} of {} goals are met, {reached} of them reach the aim.", goals.len()),
            parts: vec![
                Part::table(self.name(), "", page),
                Part::file(
                    "goals-table-2",
                    "times, steps and memory of the scenes of Table 2 at scale 1",
                    table,
                ),
                Part::file(
                    "goals-stages",
                    "growth with the number of vertices, and two threads, by stage",
                    stages,
                ),
            ],
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

/// Runs cases once and keeps the results.
struct Runs<'a> {
    bench: &'a Bench,
}

impl Runs<'_> {
    /// The case at the size of the run of this command.
    fn sized(&self, scene: &'static str, scale: f64, frames: usize, threads: usize) -> Case {
        let size = self.bench.size;
        Case {
            scene,
            scale: scale * size.pick(1.0, 0.3, 0.1),
            frames: frames.min(size.pick(frames, 4, 1)),
            threads,
        }
    }

    /// None if no time is left.
    fn now(&self, case: &Case) -> Result<Option<ProcessRun>> {
        self.kept(&format!("goals/now-{}", case.key()), || case.run())
    }

    /// None if there is no program to compare with, or no time is left.
    fn before(&self, case: &Case) -> Result<Option<ProcessRun>> {
        let Some(program) = &self.bench.before else { return Ok(None) };
        let key = format!("goals/before-{:016x}-{}", build_of(program)?, case.key());
        self.kept(&key, || case.run_with(program, self.bench.out()))
    }

    fn kept(&self, key: &str, run: impl FnOnce() -> Result<ProcessRun>) -> Result<Option<ProcessRun>> {
        match self.bench.store.find(key) {
            Some(kept) => Ok(Some(kept)),
            None if self.bench.has_time() => self.bench.store.measured(key, run).map(Some),
            None => Ok(None),
        }
    }
}

/// A number that tells the builds of a program apart, by its path, size and time of writing.
fn build_of(program: &Path) -> Result<u64> {
    let file = std::fs::metadata(program).with_context(|| format!("cannot read {}", program.display()))?;
    let mut hasher = DefaultHasher::new();
    (program, file.len(), file.modified()?).hash(&mut hasher);
    Ok(hasher.finish())
}

fn collision(seconds: &StepSeconds) -> f64 {
    seconds.search + seconds.evaluate + seconds.backward + seconds.forward
}

/// Mean over the time steps.
fn mean_of(run: &ProcessRun, value: impl Fn(&TimeStep) -> f64) -> f64 {
    mean(&run.steps.iter().map(value).collect::<Vec<f64>>())
}

fn collision_of(run: &ProcessRun) -> f64 {
    mean_of(run, |step| collision(&step.seconds))
}

fn dynamics_of(run: &ProcessRun) -> f64 {
    mean_of(run, |step| step.seconds.dynamics)
}

fn table_2(runs: &Runs<'_>, table: &mut Table) -> Result<Vec<Goal>> {
    let (mut ratios, mut walls, mut steps, mut most, mut memory) = (vec![], vec![], vec![], vec![], vec![]);
    let count = runs.bench.size.pick(TABLE_2.len(), 3, 1);
    for &(scene, frames, paper) in &TABLE_2[..count] {
        let case = runs.sized(scene, 1.0, frames, 1);
        let Some(now) = runs.now(&case)? else { break };
        let before = runs.before(&case)?;
        let Some(two) = runs.now(&Case { threads: 2, ..case })? else { break };
        let two_way_steps: Vec<f64> = now.steps.iter().map(|step| step.two_way_steps as f64).collect();
        let kilobytes = 1e-3 * now.bytes as f64 / now.vertices as f64;
        let of_before = |value: fn(&ProcessRun) -> f64| before.as_ref().map_or(f64::NAN, value);
        let [seconds, seconds_before] = [collision_of(&now), of_before(collision_of)];
        ratios.extend(before.as_ref().map(|_| seconds_before / seconds));
        walls.push(collision_of(&two) / paper);
        steps.push(mean(&two_way_steps));
        most.push(largest(&two_way_steps));
        memory.push(kilobytes);
        table.row([
            scene.into(),
            now.steps.len().into(),
            now.steps.iter().filter(|step| step.contacts > 0).count().into(),
            now.vertices.into(),
            seconds.into(),
            seconds_before.into(),
            dynamics_of(&now).into(),
            of_before(dynamics_of).into(),
            collision_of(&two).into(),
            paper.into(),
            mean(&two_way_steps).into(),
            largest(&two_way_steps).into(),
            kilobytes.into(),
        ]);
    }
    let goal = |what: &str, measured, [required, aim]: [f64; 2], unit| Goal {
        what: what.to_owned(),
        measured,
        required,
        aim,
        unit,
    };
    let mut goals = Vec::new();
    if !ratios.is_empty() {
        let what = "Table 2: collision seconds before, over those now";
        goals.push(goal(what, geometric_mean(&ratios), [4.0, 8.0], "x"));
    }
    goals.push(goal(
        "Table 2: collision seconds over the paper's, worst",
        largest(&walls),
        [40.0, 10.0],
        "x",
    ));
    goals.push(goal("Table 2: two-way steps per time step, worst mean", largest(&steps), [20.0, 10.0], ""));
    goals.push(goal("Table 2: two-way steps per time step, most", largest(&most), [100.0, 50.0], ""));
    goals.push(goal("Table 2: memory per vertex, worst", largest(&memory), [3.0, 1.5], " kB"));
    Ok(goals)
}

fn dynamics(runs: &Runs<'_>) -> Result<Vec<Goal>> {
    let mut goals = Vec::new();
    for scene in DYNAMICS {
        let frames = TABLE_2.iter().find(|row| row.0 == scene).map_or(40, |row| row.1);
        let case = runs.sized(scene, 1.0, frames, 1);
        let Some(before) = runs.before(&case)? else { continue };
        let Some(now) = runs.now(&case)? else { break };
        goals.push(Goal {
            what: format!("{scene}: seconds of the dynamics before, over those now"),
            measured: dynamics_of(&before) / dynamics_of(&now),
            required: 2.0,
            aim: 4.0,
            unit: "x",
        });
    }
    Ok(goals)
}

/// The seconds of a stage.
type Stage = fn(&StepSeconds) -> f64;

/// Stages by name, in the order of a time step.
const STAGES: [(&str, Stage); 6] = [
    ("whole time step", |s| s.total),
    ("dynamics", |s| s.dynamics),
    ("search", |s| s.search),
    ("evaluation", |s| s.evaluate),
    ("backward step", |s| s.backward),
    ("forward step", |s| s.forward),
];

/// One thread against two, and the growth of the time with the number of vertices: of the whole step and of
/// the worst stage.
fn stage_goals(runs: &Runs<'_>, table: &mut Table) -> Result<Vec<Goal>> {
    let [threads, growth] = [two_threads(runs)?, growth(runs)?];
    for (k, (name, _)) in STAGES.iter().enumerate() {
        let of = |measured: &Option<Measured>| measured.as_ref().map_or(f64::NAN, |m| m.stages[k]);
        table.row([(*name).into(), of(&growth).into(), of(&threads).into()]);
    }
    let mut goals = Vec::new();
    let mut add = |what: String, measured: f64, [required, aim]: [f64; 2], unit| {
        goals.push(Goal { what, measured, required, aim, unit });
    };
    if let Some(Measured { what, stages }) = threads {
        let (name, worst) = worst_stage(&stages, f64::lt);
        add(format!("{what}, whole time step"), stages[0], [1.6, 1.9], "x");
        add(format!("{what}, {name}"), worst, [1.6, 1.9], "x");
    }
    if let Some(Measured { what, stages }) = growth {
        let (name, worst) = worst_stage(&stages, f64::gt);
        add(format!("{what}, whole time step"), stages[0], [1.1, 1.05], "");
        add(format!("{what}, {name}"), worst, [1.1, 1.05], "");
    }
    Ok(goals)
}

/// A figure of each of the [`STAGES`].
struct Measured {
    what: String,
    stages: [f64; STAGES.len()],
}

/// The stage whose figure is worse than those of all others; the whole time step does not count.
fn worst_stage(stages: &[f64; STAGES.len()], worse: fn(&f64, &f64) -> bool) -> (&'static str, f64) {
    let mut worst = 1;
    for k in 2..STAGES.len() {
        if worse(&stages[k], &stages[worst]) {
            worst = k;
        }
    }
    (STAGES[worst].0, stages[worst])
}

/// The same case on one thread and on two.
fn on_two_threads(runs: &Runs<'_>, case: &Case) -> Result<Option<[ProcessRun; 2]>> {
    let Some(one) = runs.now(case)? else { return Ok(None) };
    Ok(runs.now(&Case { threads: 2, ..*case })?.map(|two| [one, two]))
}

/// The time steps of `sphere` before contact, and those in contact. The first one allocates buffers; it does
/// not count.
fn sphere(runs: &Runs<'_>) -> Case {
    runs.sized("sphere", 1.0, 18, 1)
}

fn two_threads(runs: &Runs<'_>) -> Result<Option<Measured>> {
    let Some([one, two]) = on_two_threads(runs, &sphere(runs))? else { return Ok(None) };
    let contact: Vec<usize> = (1..one.steps.len()).filter(|&k| one.steps[k].contacts > 0).collect();
    let sum = |run: &ProcessRun, stage: Stage| -> f64 {
        contact.iter().map(|&k| stage(&run.steps[k].seconds)).sum()
    };
    let stages = STAGES.map(|(_, stage)| sum(&one, stage) / sum(&two, stage));
    Ok(Some(Measured {
        what: "sphere, in contact: seconds of one thread over those of two".to_owned(),
        stages,
    }))
}

fn flight(runs: &Runs<'_>) -> Result<Option<Goal>> {
    let Some(run) = runs.now(&sphere(runs))? else { return Ok(None) };
    let flight = run.steps.iter().skip(1).filter(|step| step.contacts == 0);
    let shares: Vec<f64> = flight.map(|step| collision(&step.seconds) / step.seconds.total).collect();
    Ok(Some(Goal {
        what: "sphere, in flight: share of the collision stage".to_owned(),
        measured: 100.0 * mean(&shares),
        required: 10.0,
        aim: 2.0,
        unit: " %",
    }))
}

fn few_vertices(runs: &Runs<'_>) -> Result<Option<Goal>> {
    let Some([one, two]) = on_two_threads(runs, &runs.sized("drape", 0.44, 100, 1))? else { return Ok(None) };
    Ok(Some(Goal {
        what: format!("drape, {} vertices: seconds of one thread over those of two", one.vertices),
        measured: mean_of(&one, |s| s.seconds.total) / mean_of(&two, |s| s.seconds.total),
        required: 1.0,
        aim: 1.1,
        unit: "x",
    }))
}

fn growth(runs: &Runs<'_>) -> Result<Option<Measured>> {
    let mut measured = Vec::new();
    for scale in SCALES {
        let Some(run) = runs.now(&runs.sized("drape", scale, GROWTH_FRAMES, 1))? else { return Ok(None) };
        measured.push(run);
    }
    let exponent = |stage: Stage| {
        let points = measured.iter().map(|run| {
            let contact = run.steps.iter().filter(|s| s.contacts > 0);
            let seconds: Vec<f64> = contact.map(|s| stage(&s.seconds)).collect();
            ((run.vertices as f64).ln(), mean(&seconds).ln())
        });
        slope(&points.collect::<Vec<_>>())
    };
    let [low, high] = [measured[0].vertices, measured[SCALES.len() - 1].vertices];
    let what = format!("drape, {low} to {high} vertices: growth of the time");
    Ok(Some(Measured { what, stages: STAGES.map(|(_, stage)| exponent(stage)) }))
}

/// Slope of the line with the least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let x = mean(&points.iter().map(|p| p.0).collect::<Vec<_>>());
    let y = mean(&points.iter().map(|p| p.1).collect::<Vec<_>>());
    let products: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    products / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>()
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

    #[test]
    fn the_slope_is_the_exponent_of_a_power() {
        let points: Vec<(f64, f64)> =
            [1.0f64, 4.0, 9.0].map(|n| (n.ln(), (5.0 * n.powf(1.25)).ln())).to_vec();
        assert!((slope(&points) - 1.25).abs() < 1e-12);
    }
}
