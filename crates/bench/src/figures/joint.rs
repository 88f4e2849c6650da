//! Dynamics and contact in one loop (paper, Eq. 5-6, Fig. 4d), tried in the cheapest way.

use super::{Figure, Part, Section};
use crate::bench::Bench;
use crate::simulate::{Distances, Simulation, simulate};
use crate::table::{Table, largest, mean, short};
use anyhow::Result;
use bowknot::Scene;

pub struct Joint;

/// A scene with its time step's Newton iterations that count as converged.
struct Subject {
    scene: &'static str,
    /// Scale of a full and of a smaller run.
    scales: [f64; 2],
    frames: usize,
}

const SUBJECTS: [Subject; 3] = [
    Subject { scene: "needle", scales: [0.3, 0.15], frames: 12 },
    Subject { scene: "stack", scales: [0.25, 0.1], frames: 80 },
    Subject { scene: "drape", scales: [0.3, 0.2], frames: 60 },
];

/// Newton iterations of the reference.
const CONVERGED: usize = 32;

impl Figure for Joint {
    fn name(&self) -> &'static str {
        "joint"
    }

    fn title(&self) -> &'static str {
        "Eq. 5-6, Fig. 4d: dynamics and contact in one loop"
    }

    fn question(&self) -> &'static str {
        "The paper describes a joint method, whose backward step handles dynamics and contact together, and does not recommend \
         it. The cheapest form of it: one backward and one forward step after each Newton iteration of the whole time step \
         (`solver.stop.max_steps=1`), so that one loop lessens the incremental potential and keeps the rows. Against the \
         two-way method as a post-process, which goes on until its own rule is met, after each of fewer Newton iterations. Distance from the same with 32 \
         Newton iterations, over four states while contact begins. A time step of the joint loop ends wherever it is: *met*."
    }

    fn run(&self, bench: &Bench) -> Result<Section> {
        let mut table = Table::new([
            "scene",
            "method",
            "Newton iterations",
            "CPU s",
            "steps a time step",
            "most",
            "met",
            "positions, mm",
            "energy, J",
            "stretch",
            "X",
        ]);
        let mut told = Vec::new();
        for subject in bench.size.pick(&SUBJECTS[..], &SUBJECTS[..2], &SUBJECTS[..1]) {
            let at = |joint: bool, iterations: usize| run(bench, subject, joint, iterations);
            let reference = at(false, CONVERGED)?;
            let mut best: [Option<(f64, f64)>; 2] = [None; 2];
            for (joint, iterations) in [
                (false, 1),
                (false, 2),
                (false, 4),
                (false, 8),
                (true, 2),
                (true, 4),
                (true, 8),
                (true, 16),
                (true, 32),
            ] {
                if !bench.has_time() {
                    break;
                }
                let done = at(joint, iterations)?;
                let error = Distances::between(&done, &reference);
                let steps: Vec<f64> = done.steps.iter().map(|&s| s as f64).collect();
                table.row([
                    subject.scene.into(),
                    if joint { "joint".into() } else { "post-process".into() },
                    iterations.to_string().into(),
                    done.cpu_seconds().into(),
                    mean(&steps).into(),
                    largest(&steps).into(),
                    format!("{} of {}", done.met, steps.len()).into(),
                    (1e3 * error.positions).into(),
                    error.energy.into(),
                    done.max_stretch.into(),
                    done.intersections().into(),
                ]);
                let better = best[usize::from(joint)].is_none_or(|(_, least)| error.positions < least);
                if better {
                    best[usize::from(joint)] = Some((done.cpu_seconds(), error.positions));
                }
            }
            if let [Some(post), Some(joint)] = best {
                told.push(format!(
                    "{}: the nearest joint run is {} mm off in {} CPU s, the nearest post-process {} mm in {} s",
                    subject.scene,
                    short(1e3 * joint.1),
                    short(joint.0),
                    short(1e3 * post.1),
                    short(post.0)
                ));
            }
        }
        Ok(Section {
            finding: format!("{}.", told.join("; ")),
            parts: vec![Part::Table { name: self.name().to_owned(), caption: String::new(), table }],
        })
    }
}

fn run(bench: &Bench, subject: &Subject, joint: bool, iterations: usize) -> Result<Simulation> {
    let [full, small] = subject.scales;
    let mut sets = vec![format!("simulation.newton_iterations={iterations}")];
    if joint {
        sets.push("solver.stop.max_steps=1".to_owned());
    }
    let scene = Scene::builtin(subject.scene, bench.size.pick(full, small, small))?.with_sets(&sets)?;
    let word = if joint { "joint" } else { "post" };
    simulate(bench, &format!("joint/{}-{word}-{iterations}", subject.scene), &scene, subject.frames, 4)
}
