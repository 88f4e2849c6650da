//! The solution of a time step: its residual over iterations, and the cost of coming close to a converged
//! solution.

use crate::bench::Bench;
use crate::chart::{Axis, Chart, Mark, Series, Style};
use crate::figure::{Figure, Part, Report};
use crate::table::{Table, mean, median, short};
use anyhow::Result;
use bowknot::simulator::{Checkpoint, Iterated, SimulationObserver};
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};

pub struct Convergence;

/// A scene and how long it runs.
struct Subject {
    scene: &'static str,
    source: Source,
    /// Time steps of full, quick and tiny runs.
    frames: [usize; 3],
}

#[derive(Clone, Copy)]
enum Source {
    /// A built-in scene at a scale.
    Builtin(f64),
    Text(&'static str),
}

const fn subject(scene: &'static str, scale: f64, frames: [usize; 3]) -> Subject {
    Subject { scene, source: Source::Builtin(scale), frames }
}

const fn loaded(scene: &'static str, text: &'static str, frames: usize) -> Subject {
    Subject { scene, source: Source::Text(text), frames: [frames; 3] }
}

const SUBJECTS: [Subject; 5] = [
    subject("drape", 0.5, [60, 40, 30]),
    subject("stack", 0.2, [120, 60, 30]),
    subject("trampoline", 0.6, [60, 30, 16]),
    subject("needle", 0.3, [40, 14, 8]),
    subject("cards", 1.0, [100, 20, 8]),
];

/// Scenes in which bodies press on each other, whose residuals full runs show too.
const LOADED: [Subject; 5] = [
    loaded("sheet in a slot", include_str!("../../../../tests/scenes/slot.toml"), 40),
    loaded("cube on a sheet", include_str!("../../../../tests/scenes/cube-on-sheet.toml"), 100),
    loaded("strip between pads", include_str!("../../../../tests/scenes/strip-between-pads.toml"), 160),
    loaded("twisted sheet", include_str!("../../../../tests/scenes/twisted-sheet.toml"), 200),
    loaded("grains and cloth", include_str!("../../../../tests/scenes/grains-and-cloth.toml"), 100),
];

/// Iterations of each time step whose residuals are shown.
const SHOWN: usize = 16;
/// Iterations of the reference of the second part.
const REFERENCE: usize = 32;
/// Iterations that are compared with it.
const COMPARED: [usize; 5] = [1, 2, 4, 8, 16];
/// Number of states of each scene from which time steps are made.
const STATES: usize = 4;
/// Time steps made from each state, and those of them after which positions are compared.
const AGAIN: usize = 4;
const AFTER: [usize; 3] = [1, 2, AGAIN];
/// A residual stalls if it is less than this multiple of the median of the last iterations.
const STALL_FACTOR: f64 = 1.5;

/// Residuals of time steps [mean edge lengths], by time step and iteration.
type Residuals = Vec<Vec<f64>>;

/// Time steps from one state with one setting.
#[derive(Debug, Serialize, Deserialize)]
struct Again {
    /// CPU seconds of the time steps.
    cpu: f64,
    /// Newton iterations of the time steps.
    iterations: usize,
    /// Positions of the deformable vertices after the time steps of [`AFTER`] [m].
    positions: Vec<Vec<[f64; 3]>>,
}

impl Figure for Convergence {
    fn name(&self) -> &'static str {
        "convergence"
    }

    fn title(&self) -> &'static str {
        "Residual and cost of a time step over iterations"
    }

    fn question(&self) -> &'static str {
        "A time step alternates Newton iterations and collision stages. First part: the residual after k of \
         16 iterations (`solver.newton.step_tolerance=0`), medians and quartiles over the time steps of the \
         second half of small runs. The residual is the net force of inertia, elasticity, contact and \
         friction, converted to a distance in mean edge lengths. By default a time step ends at 0.003 (at \
         time steps of 1/20 s: 0.015), or after 8 iterations. \n\nSecond part: the distance of a time step \
         from a converged one, and its CPU time. From four states of each scene, the one before the first \
         contact and three more up to the end of the run, four time steps are made with each setting. Their \
         positions are compared with those of 32 iterations: root mean squares over states and vertices. \
         That reference is the method's own most exact run: distances show that it agrees with itself, not \
         that it is right. If distances fall while the residual stalls, iterations approach a state that \
         does not solve the time step. All settings start from the same states. The chart shows the end of \
         the first time step, because contact amplifies small differences; the table has all four time \
         steps."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let subjects = bench.size.pick(&SUBJECTS[..], &SUBJECTS[..2], &SUBJECTS[..1]);
        let loaded = bench.size.pick(&LOADED[..], &LOADED[..0], &LOADED[..0]);
        let (residuals, stalls) = residuals(bench, subjects, loaded)?;
        let (costs, ratios) = costs(bench, subjects)?;
        let mut report = Report { finding: format!("{stalls} {ratios}"), parts: residuals };
        report.parts.extend(costs);
        Ok(report)
    }
}

/// Residual against iterations: a chart, a table, and what they show.
fn residuals(bench: &Bench, subjects: &[Subject], loaded: &[Subject]) -> Result<(Vec<Part>, String)> {
    let mut table = Table::new(
        ["scene".to_owned(), "statistic".to_owned()]
            .into_iter()
            .chain((1..=SHOWN).map(|k| format!("residual_{k}"))),
    );
    let (mut series, mut texts) = (Vec::new(), Vec::new());
    for subject in subjects.iter().chain(loaded) {
        if !bench.has_time() {
            break;
        }
        let of_steps: Residuals = bench
            .store
            .measured(&format!("convergence/{}-residuals", subject.scene), || subject.residuals(bench))?;
        let half = &of_steps[of_steps.len() / 2..];
        let at = |share: f64| -> Vec<f64> {
            let of_iteration =
                |k: usize| half.iter().filter_map(|step| step.get(k).copied()).collect::<Vec<f64>>();
            (0..SHOWN).map(|k| quantile(&of_iteration(k), share)).collect()
        };
        for (name, share) in [("median", 0.5), ("lower quartile", 0.25), ("upper quartile", 0.75)] {
            let entries = at(share).into_iter().map(Into::into);
            table.row([subject.scene.into(), name.into()].into_iter().chain(entries));
        }
        let medians = at(0.5);
        let points = medians.iter().enumerate().map(|(k, residual)| ((k + 1) as f64, *residual));
        series.push(Series::new(subject.scene, Style::Line, points));
        texts.push(stall(subject.scene, &medians));
    }
    let chart = Chart {
        title: "Residual of the time step against iterations, medians".to_owned(),
        x: Axis::linear("Newton iterations with their collision stages"),
        y: Axis::log("residual [mean edge lengths]"),
        series,
        front: false,
    };
    let parts = vec![
        Part::Chart { name: "convergence-residual".to_owned(), chart },
        Part::table("convergence", "residual of a time step after k iterations [mean edge lengths]", table),
    ];
    Ok((parts, format!("Residuals, medians, in mean edge lengths: {}.", texts.join("; "))))
}

/// The iteration from which on residuals stall.
fn stall(scene: &str, medians: &[f64]) -> String {
    let (first, end) = (medians[0], median(&medians[SHOWN / 2..]));
    let from = medians.iter().position(|residual| *residual < STALL_FACTOR * end).map_or(SHOWN, |k| k + 1);
    let lowest = medians.iter().copied().fold(f64::INFINITY, f64::min);
    if from > SHOWN / 2 {
        return format!("`{scene}` falls from {} to {} in {SHOWN} iterations", short(first), short(lowest));
    }
    format!("`{scene}` falls from {} and stalls at {} from iteration {from} on", short(first), short(end))
}

/// Distance from the reference against CPU time: a chart, a table, and what they show.
fn costs(bench: &Bench, subjects: &[Subject]) -> Result<(Vec<Part>, String)> {
    let mut header = ["scene", "newton_iterations", "mean_iterations", "cpu_ms"].map(str::to_owned).to_vec();
    header.extend(AFTER.iter().map(|n| format!("distance_{n}_mm")));
    header.extend(AFTER.iter().map(|n| format!("distance_{n}_edges")));
    let mut table = Table::new(header);
    let (mut series, mut texts) = (Vec::new(), Vec::new());
    for subject in subjects {
        if !bench.has_time() {
            break;
        }
        let (edge, states) = subject.states(bench)?;
        let reference = subject.again(bench, &states, Some(REFERENCE))?;
        let mut marks = Vec::new();
        for iterations in COMPARED.map(Some).into_iter().chain([None]) {
            let done = subject.again(bench, &states, iterations)?;
            let steps = (AGAIN * states.len()) as f64;
            let cpu = done.iter().map(|a| a.cpu).sum::<f64>() / steps;
            let made = done.iter().map(|a| a.iterations).sum::<usize>() as f64 / steps;
            let off: Vec<f64> = (0..AFTER.len()).map(|k| distance(&done, &reference, k)).collect();
            let name = iterations.map_or("default".to_owned(), |n| n.to_string());
            let millimeters = off.iter().map(|d| (1e3 * d).into());
            let edges = off.iter().map(|d| (d / edge).into());
            table.row(
                [subject.scene.into(), name.clone().into(), made.into(), (1e3 * cpu).into()]
                    .into_iter()
                    .chain(millimeters)
                    .chain(edges),
            );
            marks.push(Mark { x: cpu, y: off[0] / edge, label: name });
        }
        if let [.., most, default] = &marks[..] {
            let text = |mark: &Mark| format!("{} in {} ms", short(mark.y), short(1e3 * mark.x));
            texts.push(format!("`{}` {}, {}, {}", subject.scene, text(&marks[0]), text(default), text(most)));
        }
        // Marks are joined in the order of their cost.
        marks.sort_by(|a, b| a.x.total_cmp(&b.x));
        series.push(Series { name: subject.scene.to_owned(), points: marks, style: Style::Line });
    }
    let chart = Chart {
        title: format!("Distance of one time step from that of {REFERENCE} iterations, against CPU time"),
        x: Axis::log("CPU seconds of a time step"),
        y: Axis::log("distance [mean edge lengths]"),
        series,
        front: false,
    };
    let shows = format!(
        "RMS distance from {REFERENCE} iterations after 1, 2 and 4 time steps; CPU time of a time step; \
         `default`: default tolerance and limit"
    );
    let parts = vec![
        Part::Chart { name: "convergence-cost".to_owned(), chart },
        Part::table("convergence-cost", shows, table),
    ];
    let finding = format!(
        "Distance of one time step from that of {REFERENCE} iterations, in mean edge lengths, and its CPU \
         time, with 1 iteration, the default, and {} iterations: {}.",
        COMPARED[COMPARED.len() - 1],
        texts.join("; ")
    );
    Ok((parts, finding))
}

impl Subject {
    fn frames(&self, bench: &Bench) -> usize {
        let [full, quick, tiny] = self.frames;
        bench.size.pick(full, quick, tiny)
    }

    /// The scene with exactly so many iterations in each time step; none: the default rule.
    fn scene(&self, iterations: Option<usize>) -> Result<Scene> {
        let mut sets: Vec<String> = Vec::new();
        if let Some(count) = iterations {
            sets.push("solver.newton.step_tolerance=0".to_owned());
            sets.push(format!("simulation.newton_iterations={count}"));
        }
        let scene = match self.source {
            Source::Builtin(scale) => Scene::builtin(self.scene, scale)?,
            Source::Text(text) => {
                // Every time step makes its iterations.
                sets.push("solver.sleep.enabled=false".to_owned());
                Scene::from_toml(text, ".")?
            }
        };
        Ok(scene.with_sets(&sets)?)
    }

    fn residuals(&self, bench: &Bench) -> Result<Residuals> {
        let mut simulator = Simulator::new(&self.scene(Some(SHOWN))?)?;
        let mut seen = Seen { edge: simulator.resolver().scene().lengths().edge, residuals: Vec::new() };
        for _ in 0..self.frames(bench) {
            seen.residuals.push(Vec::with_capacity(SHOWN));
            simulator.step_observed(&mut seen)?;
        }
        Ok(seen.residuals)
    }

    /// Mean edge length [m], and states of the scene under default settings: the one before the first time
    /// step with contact, and others from there to the end of the run.
    fn states(&self, bench: &Bench) -> Result<(f64, Vec<Checkpoint>)> {
        let mut simulator = Simulator::new(&self.scene(None)?)?;
        let (mut states, mut first) = (vec![simulator.checkpoint()], None);
        for step in 0..self.frames(bench) {
            let done = simulator.step()?;
            if done.repulsion_springs + done.contact_rows > 0 {
                first = first.or(Some(step));
            }
            states.push(simulator.checkpoint());
        }
        let (first, last) = (first.unwrap_or(0), states.len() - 1);
        let chosen = (0..STATES).map(|k| states[first + k * (last - first) / (STATES - 1)].clone()).collect();
        Ok((simulator.resolver().scene().lengths().edge, chosen))
    }

    /// Makes time steps from each of the states.
    fn again(&self, bench: &Bench, states: &[Checkpoint], iterations: Option<usize>) -> Result<Vec<Again>> {
        let setting = iterations.map_or("default".to_owned(), |n| n.to_string());
        bench.store.measured(&format!("convergence/{}-{setting}", self.scene), || {
            let mut simulator = Simulator::new(&self.scene(iterations)?)?;
            let deformable = simulator.world().deformable_vertices;
            let mut all = Vec::new();
            for state in states {
                simulator.restore(state)?;
                let mut again = Again { cpu: 0.0, iterations: 0, positions: Vec::new() };
                for step in 1..=AGAIN {
                    let done = simulator.step()?;
                    again.cpu += done.cpu_seconds;
                    again.iterations += done.newton_iterations;
                    if AFTER.contains(&step) {
                        let x = &simulator.positions()[..deformable];
                        again.positions.push(x.iter().map(|p| [p.x, p.y, p.z]).collect());
                    }
                }
                all.push(again);
            }
            Ok(all)
        })
    }
}

/// Records residuals, in mean edge lengths.
struct Seen {
    edge: f64,
    residuals: Residuals,
}

impl SimulationObserver for Seen {
    fn iterated(&mut self, iterated: &Iterated) {
        if let Some(step) = self.residuals.last_mut() {
            step.push(iterated.residual.distance / self.edge);
        }
    }
}

/// Root mean square distance over states and vertices, after the number of time steps in place `after` of
/// [`AFTER`] [m].
fn distance(a: &[Again], b: &[Again], after: usize) -> f64 {
    let square = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.positions[after].iter().zip(&b.positions[after]));
    mean(&pairs.map(square).collect::<Vec<f64>>()).sqrt()
}

/// The value below which a share of the values lies; NaN of no values.
fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().saturating_sub(1) as f64;
    let (low, high) = (sorted.get(place.floor() as usize), sorted.get(place.ceil() as usize));
    match (low, high) {
        (Some(low), Some(high)) => low + (high - low) * place.fract(),
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stalls_are_distinguished_from_steady_falls() {
        let stalls: Vec<f64> = (0..SHOWN).map(|k| if k < 2 { 0.5 } else { 0.01 }).collect();
        assert_eq!(stall("a", &stalls), "`a` falls from 0.500 and stalls at 0.0100 from iteration 3 on");
        let falls: Vec<f64> = (0..SHOWN).map(|k| 0.5f64.powi(k as i32)).collect();
        assert!(stall("b", &falls).starts_with("`b` falls from 1.00 to 3.1e-5"), "{}", stall("b", &falls));
        assert_eq!(quantile(&[3.0, 1.0, 2.0, 4.0, 5.0], 0.25), 2.0);
    }
}
