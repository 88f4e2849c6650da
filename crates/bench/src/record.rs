//! Records collision problems of scenes: at most ten per scene and kind of targets, spread over the time
//! steps in contact.

use crate::bench::{Bench, Size};
use crate::files::write;
use crate::table::Table;
use crate::targets::Targets;
use anyhow::{Context, Result};
use bowknot::constraints::STRETCH_LIMIT;
use bowknot::recording::Recorder;
use bowknot::recording::States;
use bowknot::scene::RepulsionParams;
use bowknot::simulator::{CollisionProblem, SimulationObserver};
use bowknot::{Scene, Simulator};
use bowknot_errors::counted;
use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// The collision problems of a scene, and how they are recorded.
#[derive(Clone, Copy, Debug)]
pub struct ProblemSet {
    /// Its name, which is also that of its folder.
    pub name: &'static str,
    /// The built-in scene.
    scene: &'static str,
    /// Time step [s]; none: the scene's own.
    time_step: Option<f64>,
    /// What the dynamics knows of contacts.
    targets: Targets,
    /// Scales of a full, a quick and a tiny run.
    scales: [f64; 3],
    /// Time steps of a full, a quick and a tiny run.
    frames: [usize; 3],
}

const fn set(scene: &'static str, scales: [f64; 3], frames: [usize; 3]) -> ProblemSet {
    ProblemSet { name: scene, scene, time_step: None, targets: Targets::Aware, scales, frames }
}

/// The scene of another set with contact-unaware targets, for `frames` time steps.
const fn unaware(name: &'static str, set: ProblemSet, frames: [usize; 3]) -> ProblemSet {
    ProblemSet { name, targets: Targets::Unaware, frames, ..set }
}

/// The scene of another set with targets of the paper's repulsion.
const fn repelled(name: &'static str, set: ProblemSet) -> ProblemSet {
    ProblemSet { name, targets: Targets::Repelled, ..set }
}

/// The scene of another set with another time step, for `frames` of them.
const fn stepped(name: &'static str, set: ProblemSet, time_step: f64, frames: [usize; 3]) -> ProblemSet {
    ProblemSet { name, time_step: Some(time_step), frames, ..set }
}

const BOW_KNOT: ProblemSet = set("bow-knot", [0.25, 0.1, 0.1], [300, 160, 60]);
const REEF_KNOT: ProblemSet = set("reef-knot", [0.35, 0.15, 0.1], [280, 120, 60]);
const NEEDLE: ProblemSet = set("needle", [0.52, 0.25, 0.15], [40, 25, 20]);
const FUNNEL: ProblemSet = set("funnel", [0.2, 0.2, 0.2], [60, 20, 8]);
const STACK: ProblemSet = set("stack", [0.5, 0.2, 0.1], [120, 70, 50]);
const TUBE: ProblemSet = set("tube", [0.45, 0.2, 0.15], [150, 100, 90]);
const DRESS: ProblemSet = set("dress", [0.2, 0.1, 0.08], [120, 30, 10]);
const UNAWARE_NEEDLE: ProblemSet = unaware("needle-unaware", NEEDLE, [40, 25, 20]);
const UNAWARE_STACK: ProblemSet = unaware("stack-unaware", STACK, [120, 70, 50]);
const UNAWARE_BOW_KNOT: ProblemSet = unaware("bow-knot-unaware", BOW_KNOT, [300, 160, 60]);
const UNAWARE_REEF_KNOT: ProblemSet = unaware("reef-knot-unaware", REEF_KNOT, [280, 120, 60]);

const UNAWARE_TUBE: ProblemSet = unaware("tube-unaware", TUBE, [150, 100, 90]);
const UNAWARE_DRESS: ProblemSet = unaware("dress-unaware", DRESS, [120, 30, 10]);

/// The sets that `record` writes. A full run of each takes from seconds to a few minutes; it ends where
/// contact is hardest or the scene is at rest.
pub const PROBLEM_SETS: [ProblemSet; 17] = [
    BOW_KNOT,
    REEF_KNOT,
    NEEDLE,
    FUNNEL,
    STACK,
    TUBE,
    DRESS,
    set("mat", [0.3, 0.12, 0.1], [220, 200, 190]),
    set("hair", [0.12, 0.05, 0.05], [200, 60, 40]),
    set("sand", [0.25, 0.1, 0.08], [200, 80, 50]),
    UNAWARE_BOW_KNOT,
    UNAWARE_REEF_KNOT,
    UNAWARE_NEEDLE,
    unaware("funnel-unaware", FUNNEL, [40, 20, 8]),
    UNAWARE_STACK,
    UNAWARE_TUBE,
    UNAWARE_DRESS,
];

/// Sets with other time steps, for single figures: knots at 1/1000 s (paper, section 3.3), the needle at
/// 1/100 s and the stack at 1/20 s (Fig. 16).
const OTHER_TIME_STEPS: [ProblemSet; 6] = [
    stepped("bow-knot-1000", ProblemSet { scales: [0.12, 0.1, 0.1], ..BOW_KNOT }, 0.001, [1600, 900, 500]),
    stepped("reef-knot-1000", ProblemSet { scales: [0.2, 0.1, 0.1], ..REEF_KNOT }, 0.001, [1400, 700, 400]),
    stepped(
        "bow-knot-unaware-1000",
        ProblemSet { scales: [0.12, 0.1, 0.1], ..UNAWARE_BOW_KNOT },
        0.001,
        [1600, 900, 500],
    ),
    stepped(
        "reef-knot-unaware-1000",
        ProblemSet { scales: [0.2, 0.1, 0.1], ..UNAWARE_REEF_KNOT },
        0.001,
        [1400, 700, 400],
    ),
    stepped("needle-unaware-100", UNAWARE_NEEDLE, 0.01, [100, 80, 60]),
    stepped("stack-unaware-20", UNAWARE_STACK, 0.05, [24, 14, 10]),
];

/// Sets with targets of the paper's repulsion, for comparisons of methods; `record` writes them too.
pub const REPELLED: [ProblemSet; 6] = [
    repelled("needle-repelled", UNAWARE_NEEDLE),
    repelled("stack-repelled", UNAWARE_STACK),
    repelled("tube-repelled", UNAWARE_TUBE),
    repelled("bow-knot-repelled", UNAWARE_BOW_KNOT),
    repelled("reef-knot-repelled", UNAWARE_REEF_KNOT),
    repelled("dress-repelled", UNAWARE_DRESS),
];

/// Number of scenes in [`PROBLEM_SETS`]: each has a set with contact-aware targets, and some another one with
/// contact-unaware targets.
pub fn contact_aware_scenes() -> usize {
    PROBLEM_SETS.iter().filter(|set| set.targets == Targets::Aware).count()
}

/// Number of problems kept of each set.
const KEPT: usize = 10;

impl ProblemSet {
    /// The set of that name.
    pub fn of(name: &str) -> Result<&'static ProblemSet> {
        let mut all = PROBLEM_SETS.iter().chain(&OTHER_TIME_STEPS).chain(&REPELLED);
        all.find(|set| set.name == name).with_context(|| format!("no problems of {name}"))
    }

    fn scale(&self, size: Size) -> f64 {
        let [full, quick, tiny] = self.scales;
        size.pick(full, quick, tiny)
    }

    /// The command that runs the scene.
    pub fn command(&self, size: Size) -> String {
        let [full, quick, tiny] = self.frames;
        let frames = size.pick(full, quick, tiny);
        let time_step = self.time_step.map_or_else(String::new, |dt| format!(" --dt {dt}"));
        let repulsion = match self.targets {
            Targets::Aware => "",
            Targets::Unaware => " --set solver.repulsion.stiffness=0",
            Targets::Repelled => {
                " --set solver.repulsion.law=quadratic --set solver.repulsion.stiffness=1000"
            }
        };
        let sigma = format!(" --set contact.stretch_limit={STRETCH_LIMIT}");
        let (scene, scale) = (self.scene, self.scale(size));
        format!("bowknot run {scene} --scale {scale} --frames {frames}{time_step}{repulsion}{sigma}")
    }

    /// Files of the problems in the order of time, recorded now if they do not exist.
    pub fn files(&self, bench: &Bench) -> Result<Vec<PathBuf>> {
        let folder = bench.out().join("states").join(self.name);
        let done = folder.join("done.txt");
        if !done.exists() {
            println!("  recording {}", self.command(bench.size));
            bench.recorded(|| self.record(bench, &folder))?;
        }
        let list = fs::read_to_string(&done).with_context(|| format!("cannot read {}", done.display()))?;
        Ok(list.lines().map(|name| folder.join(name)).collect())
    }

    fn record(&self, bench: &Bench, folder: &std::path::Path) -> Result<()> {
        let mut scene = Scene::builtin(self.scene, self.scale(bench.size))?;
        scene.simulation.dt = self.time_step.unwrap_or(scene.simulation.dt);
        // The paper's limit for every fabric, so that its method gets the problems that it was made for.
        scene.contact.stretch_limit = Some(STRETCH_LIMIT);
        match self.targets {
            Targets::Aware => {}
            Targets::Unaware => scene.solver.repulsion.stiffness = 0.0,
            Targets::Repelled => scene.solver.repulsion = RepulsionParams::paper(),
        }
        let [full, quick, tiny] = self.frames;
        let frames = bench.size.pick(full, quick, tiny);
        let problems = in_contact(&scene, frames, bench.size.pick(KEPT, 3, 2))?;
        fs::create_dir_all(folder).with_context(|| format!("cannot create {}", folder.display()))?;
        let mut names = Vec::new();
        for Kept { step, states } in &problems {
            let name = format!("{step:06}.npz");
            states.write(&folder.join(&name))?;
            names.push(name);
        }
        // Written last: if it exists, all problems do.
        write(&folder.join("done.txt"), &(names.join("\n") + "\n"))
    }
}

/// Records the problems that are missing and writes a list of all.
pub fn all(bench: &Bench) -> Result<()> {
    let mut table = Table::new(["file", "scene", "time step", "vertices", "triangles", "command"]);
    for set in PROBLEM_SETS.iter().chain(&REPELLED) {
        for file in set.files(bench)? {
            let states = States::read(&file)?;
            let step = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            table.row([
                format!("{}/{step}.npz", set.name).into(),
                set.scene.into(),
                step.trim_start_matches('0').into(),
                states.x.len().into(),
                states.triangles.len().into(),
                set.command(bench.size).into(),
            ]);
        }
    }
    let folder = bench.out().join("states");
    write(&folder.join("states.csv"), &table.csv())?;
    println!("{}", folder.display());
    Ok(())
}

/// A problem and its time step.
struct Kept {
    step: usize,
    states: States,
}

/// Runs a scene and keeps `count` problems, spread evenly over the time steps with contact rows. A run
/// without contact is an error: the number of frames or the scale is wrong.
fn in_contact(scene: &Scene, frames: usize, count: usize) -> Result<Vec<Kept>> {
    let mut simulator = Simulator::new(scene)?;
    let mut last = Last { recorder: Recorder::new(&simulator), problem: None };
    let mut kept: Vec<Kept> = Vec::new();
    // Every `stride`th time step in contact is kept. The stride doubles when too many are kept, which bounds
    // the memory.
    let (mut seen, mut stride) = (0, 1);
    for step in 1..=frames {
        let statistics = simulator.step_observed(&mut last)?;
        if statistics.contact_rows + statistics.pressing_contacts == 0 {
            continue;
        }
        if seen % stride == 0
            && let Some(states) = last.problem.take()
        {
            kept.push(Kept { step, states });
        }
        seen += 1;
        if kept.len() == 4 * count {
            stride *= 2;
            let mut place = 0;
            kept.retain(|_| {
                place += 1;
                place % 2 == 1
            });
        }
    }
    anyhow::ensure!(
        !kept.is_empty(),
        "no contact in {} of {}",
        counted(frames, "time step", "time steps"),
        scene.name()
    );
    let total = kept.len();
    let chosen: Vec<usize> =
        (0..count.min(total)).map(|k| (2 * k + 1) * total / (2 * count.min(total))).collect();
    let mut place = 0;
    kept.retain(|_| {
        place += 1;
        chosen.contains(&(place - 1))
    });
    Ok(kept)
}

/// Keeps the first problem of the present time step.
struct Last {
    recorder: Recorder,
    problem: Option<States>,
}

impl SimulationObserver for Last {
    fn problem(&mut self, problem: &CollisionProblem<'_>) -> ControlFlow<()> {
        if problem.iteration == 0 {
            self.problem = Some(self.recorder.states(problem));
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_come_from_time_steps_in_contact() {
        let scene = Scene::builtin("needle", 0.1).expect("a scene");
        let kept = in_contact(&scene, 14, 3).expect("contact");
        assert_eq!(kept.len(), 3);
        assert!(kept.windows(2).all(|w| w[0].step < w[1].step));
        assert!(kept[0].step > 1, "the sheet falls first");
        assert!(in_contact(&scene, 1, 3).is_err(), "no contact yet");
    }
}
