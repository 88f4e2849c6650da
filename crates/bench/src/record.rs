//! Collision problems of scenes: at most ten each, spread over the time steps in contact.

use crate::bench::{Bench, Size};
use crate::table::Table;
use anyhow::{Context, Result};
use bowknot::constraints::STRETCH_LIMIT;
use bowknot::recording::Recorder;
use bowknot::recording::States;
use bowknot::simulator::{CollisionProblem, SimulationObserver};
use bowknot::{Scene, Simulator};
use std::fs;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// A scene that problems are recorded of.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Its name here, that of its folder.
    pub name: &'static str,
    /// The built-in scene.
    scene: &'static str,
    /// Time step, if not the scene's own [s].
    time_step: Option<f64>,
    /// Whether the dynamics knows of no contact, as the paper's: targets then go deep through what is in the way. Bowknot's
    /// own guesses contacts, so that its targets meet little.
    blind: bool,
    /// Scale of a full, a quick and a tiny run.
    scales: [f64; 3],
    /// Time steps of a full, a quick and a tiny run.
    frames: [usize; 3],
}

const fn spec(scene: &'static str, scales: [f64; 3], frames: [usize; 3]) -> Spec {
    Spec { name: scene, scene, time_step: None, blind: false, scales, frames }
}

/// The scene of another with a dynamics that is blind to contact, for `frames` time steps.
const fn blind(name: &'static str, spec: Spec, frames: [usize; 3]) -> Spec {
    Spec { name, blind: true, frames, ..spec }
}

/// The scene of another at another time step, for `frames` of them.
const fn stepped(name: &'static str, spec: Spec, time_step: f64, frames: [usize; 3]) -> Spec {
    Spec { name, time_step: Some(time_step), frames, ..spec }
}

const BOW_KNOT: Spec = spec("bow-knot", [0.25, 0.1, 0.1], [300, 160, 60]);
const REEF_KNOT: Spec = spec("reef-knot", [0.35, 0.15, 0.1], [280, 120, 60]);
const NEEDLE: Spec = spec("needle", [0.52, 0.25, 0.15], [40, 25, 20]);
const FUNNEL: Spec = spec("funnel", [0.2, 0.2, 0.2], [60, 20, 8]);
const STACK: Spec = spec("stack", [0.5, 0.2, 0.1], [120, 70, 50]);
const TUBE: Spec = spec("tube", [0.45, 0.2, 0.15], [150, 100, 90]);
const DRESS: Spec = spec("dress", [0.2, 0.1, 0.08], [120, 30, 10]);
const BLIND_NEEDLE: Spec = blind("needle-blind", NEEDLE, [40, 25, 20]);
const BLIND_STACK: Spec = blind("stack-blind", STACK, [120, 70, 50]);
const BLIND_BOW_KNOT: Spec = blind("bow-knot-blind", BOW_KNOT, [300, 160, 60]);
const BLIND_REEF_KNOT: Spec = blind("reef-knot-blind", REEF_KNOT, [280, 120, 60]);

/// All that are recorded for anyone. A full run of each takes from seconds to a few minutes; frames end where contact is at
/// its hardest or the scene is at rest.
pub const SPECS: [Spec; 17] = [
    BOW_KNOT,
    REEF_KNOT,
    NEEDLE,
    FUNNEL,
    STACK,
    TUBE,
    DRESS,
    spec("mat", [0.3, 0.12, 0.1], [220, 200, 190]),
    spec("hair", [0.12, 0.05, 0.05], [200, 60, 40]),
    spec("sand", [0.25, 0.1, 0.08], [200, 80, 50]),
    BLIND_BOW_KNOT,
    BLIND_REEF_KNOT,
    BLIND_NEEDLE,
    blind("funnel-blind", FUNNEL, [40, 20, 8]),
    BLIND_STACK,
    blind("tube-blind", TUBE, [150, 100, 90]),
    blind("dress-blind", DRESS, [120, 30, 10]),
];

/// For figures alone, at other time steps: knots at 1/1000 s (paper, section 3.3), the needle at 1/100 s and the stack at
/// 1/20 s (Fig. 16).
const OTHER_STEPS: [Spec; 6] = [
    stepped("bow-knot-1000", Spec { scales: [0.12, 0.1, 0.1], ..BOW_KNOT }, 0.001, [1600, 900, 500]),
    stepped("reef-knot-1000", Spec { scales: [0.2, 0.1, 0.1], ..REEF_KNOT }, 0.001, [1400, 700, 400]),
    stepped(
        "bow-knot-blind-1000",
        Spec { scales: [0.12, 0.1, 0.1], ..BLIND_BOW_KNOT },
        0.001,
        [1600, 900, 500],
    ),
    stepped(
        "reef-knot-blind-1000",
        Spec { scales: [0.2, 0.1, 0.1], ..BLIND_REEF_KNOT },
        0.001,
        [1400, 700, 400],
    ),
    stepped("needle-blind-100", BLIND_NEEDLE, 0.01, [100, 80, 60]),
    stepped("stack-blind-20", BLIND_STACK, 0.05, [24, 14, 10]),
];

/// Problems kept of each scene.
const KEPT: usize = 10;

impl Spec {
    /// The one of that name.
    pub fn of(name: &str) -> Result<&'static Spec> {
        let mut all = SPECS.iter().chain(&OTHER_STEPS);
        all.find(|spec| spec.name == name).with_context(|| format!("no problems of {name}"))
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
        let blind = if self.blind { " --set solver.repulsion.stiffness=0" } else { "" };
        let sigma = format!(" --set contact.stretch_limit={STRETCH_LIMIT}");
        let (scene, scale) = (self.scene, self.scale(size));
        format!("bowknot run {scene} --scale {scale} --frames {frames}{time_step}{blind}{sigma}")
    }

    /// Files of the scene's problems in the order of time, recorded now if they are not there.
    pub fn files(&self, bench: &Bench) -> Result<Vec<PathBuf>> {
        let folder = bench.out().join("states").join(self.name);
        let done = folder.join("done.txt");
        if !done.exists() {
            println!("  recording {}", self.command(bench.size));
            self.record(bench, &folder)?;
        }
        let list = fs::read_to_string(&done).with_context(|| format!("cannot read {}", done.display()))?;
        Ok(list.lines().map(|name| folder.join(name)).collect())
    }

    fn record(&self, bench: &Bench, folder: &std::path::Path) -> Result<()> {
        let mut scene = Scene::builtin(self.scene, self.scale(bench.size))?;
        scene.simulation.dt = self.time_step.unwrap_or(scene.simulation.dt);
        // The paper's for every fabric, so that its own method meets the problems that it is made for.
        scene.twoway.contact.stretch_limit = Some(STRETCH_LIMIT);
        if self.blind {
            scene.repulsion.stiffness = 0.0;
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
        // Last: its being there tells that all are.
        crate::bench::write(&folder.join("done.txt"), &(names.join("\n") + "\n"))
    }
}

/// Records what is missing and writes a list of all.
pub fn all(bench: &Bench) -> Result<()> {
    let mut table = Table::new(["file", "scene", "time step", "vertices", "triangles", "command"]);
    for spec in &SPECS {
        for file in spec.files(bench)? {
            let states = States::read(&file)?;
            let step = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            table.row([
                format!("{}/{step}.npz", spec.name).into(),
                spec.scene.into(),
                step.trim_start_matches('0').into(),
                states.x.len().into(),
                states.triangles.len().into(),
                spec.command(bench.size).into(),
            ]);
        }
    }
    let folder = bench.out().join("states");
    crate::bench::write(&folder.join("states.csv"), &table.csv())?;
    println!("{}", folder.display());
    Ok(())
}

/// A problem and the time step that it is of.
struct Kept {
    step: usize,
    states: States,
}

/// Runs a scene and keeps `count` problems, spread evenly over the time steps with contact rows. A run without any is an
/// error: its frames or its scale are wrong.
fn in_contact(scene: &Scene, frames: usize, count: usize) -> Result<Vec<Kept>> {
    let mut simulator = Simulator::new(scene)?;
    let mut last = Last { recorder: Recorder::new(&simulator), problem: None };
    let mut kept: Vec<Kept> = Vec::new();
    // Every `stride`th time step in contact is kept; it doubles when too many are, so that memory holds few.
    let (mut seen, mut stride) = (0, 1);
    for step in 1..=frames {
        let statistics = simulator.step_observed(&mut last)?;
        if statistics.contact_rows == 0 {
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
    anyhow::ensure!(!kept.is_empty(), "no contact in {frames} time steps of {}", scene.name());
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
    fn problems_are_of_steps_in_contact() {
        let scene = Scene::builtin("needle", 0.1).expect("a scene");
        let kept = in_contact(&scene, 14, 3).expect("contact");
        assert_eq!(kept.len(), 3);
        assert!(kept.windows(2).all(|w| w[0].step < w[1].step));
        assert!(kept[0].step > 1, "the sheet falls first");
        assert!(in_contact(&scene, 1, 3).is_err(), "no contact yet");
    }
}
