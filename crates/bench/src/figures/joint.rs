//! Dynamics and contact in one loop (paper, Eq. 5-6, Fig. 4d), in its cheapest form.

use crate::bench::Bench;
use crate::figure::{Figure, Part, Report};
use crate::table::{Table, mean, times};
use anyhow::Result;
use bowknot::check::StateOptions;
use bowknot::simulator::Checkpoint;
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};

pub struct Joint;

/// A scene, and the time steps that are compared.
struct Subject {
    scene: &'static str,
    /// Scale of a full and of a smaller run.
    scales: [f64; 2],
    /// Number of time steps before each of them; all are in contact.
    before: [usize; 4],
}

const SUBJECTS: [Subject; 3] = [
    Subject { scene: "needle", scales: [0.4, 0.15], before: [5, 7, 9, 12] },
    Subject { scene: "stack", scales: [0.4, 0.1], before: [40, 50, 60, 80] },
    Subject { scene: "drape", scales: [0.4, 0.2], before: [30, 40, 50, 60] },
];

/// Newton iterations of the reference.
const CONVERGED: usize = 64;
/// Newton iterations of the post-process and of the joint loop.
const POST: [usize; 5] = [1, 2, 4, 8, 16];
const JOINT: [usize; 6] = [2, 4, 8, 16, 32, 64];

/// Number of Newton iterations in the finding.
const COMPARED: usize = 8;

/// The end of one time step from each state of a scene.
#[derive(Debug, Serialize, Deserialize)]
struct Ends {
    positions: Vec<Vec<[f64; 3]>>,
    /// Means over the states.
    cpu: f64,
    two_way_steps: f64,
    /// Largest over the states.
    stretch: f64,
    met: usize,
    intersections: usize,
}

impl Figure for Joint {
    fn name(&self) -> &'static str {
        "joint"
    }

    fn title(&self) -> &'static str {
        "Eq. 5-6, Fig. 4d: dynamics and contact in one loop"
    }

    fn question(&self) -> &'static str {
        "The paper describes a joint method, whose backward step handles dynamics and contact together (Eq. 5 \
         and 6), and does not recommend it. Bowknot's own runs are of this kind: Newton's method solves for \
         bodies and contacts together, and after each of its iterations the collision stage leads the way to \
         its target. Both runs compared here are. They differ in how far the collision stage goes. The \
         cheapest form: one backward and one forward step after each Newton \
         iteration of the whole time step (`solver.stop.max_steps=1`), so that one loop reduces the \
         incremental potential and keeps the rows. It is compared with the two-way method as a post-process, \
         which runs until its own rule is met, after each of fewer Newton iterations. One time step from \
         each of four states in contact. The distance is the root mean square over the positions from those \
         after 64 Newton iterations with the post-process. One step seldom meets the stopping rule."
    }

    fn run(&self, bench: &Bench) -> Result<Report> {
        let mut table = Table::new([
            "scene",
            "method",
            "newton_iterations",
            "cpu_s",
            "two_way_steps",
            "distance_mm",
            "time_steps",
            "met_rule",
            "max_stretch",
            "intersections",
        ]);
        let mut texts = Vec::new();
        for subject in bench.size.pick(&SUBJECTS[..], &SUBJECTS[..2], &SUBJECTS[..1]) {
            let reference = ends(bench, subject, false, CONVERGED)?;
            // Joint or not, Newton iterations, CPU seconds, distance.
            let mut rows = Vec::new();
            for (joint, counts) in [(false, &POST[..]), (true, &JOINT[..])] {
                for &iterations in counts {
                    if !bench.has_time() {
                        break;
                    }
                    let done = ends(bench, subject, joint, iterations)?;
                    let distance = rms_distance(&done, &reference);
                    rows.push((joint, iterations, done.cpu, distance));
                    table.row([
                        subject.scene.into(),
                        if joint { "joint".into() } else { "post-process".into() },
                        iterations.to_string().into(),
                        done.cpu.into(),
                        done.two_way_steps.into(),
                        (1e3 * distance).into(),
                        done.positions.len().into(),
                        done.met.into(),
                        done.stretch.into(),
                        done.intersections.into(),
                    ]);
                }
            }
            texts.extend(ratios(subject.scene, &rows));
        }
        Ok(Report {
            finding: format!(
                "The joint loop with {COMPARED} Newton iterations against the post-process with as many: {}.",
                texts.join("; ")
            ),
            parts: vec![Part::table(
                self.name(),
                "one time step by the joint loop and by the post-process: CPU time, distance from 64 \
                 iterations",
                table,
            )],
        })
    }
}

/// The joint loop over the post-process with as many Newton iterations.
fn ratios(scene: &str, rows: &[(bool, usize, f64, f64)]) -> Option<String> {
    let find = |joint: bool| rows.iter().find(|row| row.0 == joint && row.1 == COMPARED);
    let ((.., post_cpu, post_distance), (.., cpu, distance)) = (find(false)?, find(true)?);
    Some(format!(
        "{scene}: {} the CPU time, {} the distance",
        times(cpu / post_cpu),
        times(distance / post_distance)
    ))
}

/// Root mean square distance over all states and vertices [m].
fn rms_distance(a: &Ends, b: &Ends) -> f64 {
    let square = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    let pairs = a.positions.iter().flatten().zip(b.positions.iter().flatten());
    let squares: Vec<f64> = pairs.map(square).collect();
    mean(&squares).sqrt()
}

fn scene(bench: &Bench, subject: &Subject, sets: &[String]) -> Result<Scene> {
    let [full, small] = subject.scales;
    Ok(Scene::builtin(subject.scene, bench.size.pick(full, small, small))?.with_sets(sets)?)
}

fn ends(bench: &Bench, subject: &Subject, joint: bool, iterations: usize) -> Result<Ends> {
    let word = if joint { "joint" } else { "post" };
    bench.store.measured(&format!("joint/{}-{word}-{iterations}", subject.scene), || {
        let mut sets = vec![
            format!("simulation.newton_iterations={iterations}"),
            "solver.newton.step_tolerance=0".to_owned(),
        ];
        if joint {
            sets.push("solver.stop.max_steps=1".to_owned());
        }
        let scene = scene(bench, subject, &sets)?;
        let mut ends = Ends {
            positions: Vec::new(),
            cpu: 0.0,
            two_way_steps: 0.0,
            stretch: 0.0,
            met: 0,
            intersections: 0,
        };
        for state in states(bench, subject)? {
            let mut simulator = Simulator::new(&scene)?;
            simulator.restore(&state)?;
            let done = simulator.step()?;
            let x = simulator.positions();
            let world = simulator.world();
            let report = simulator
                .judge()
                .check_state(&x[..world.collision_vertices()], &StateOptions { limit: 0, distance: false })?;
            ends.positions.push(x[..world.deformable_vertices].iter().map(|p| [p.x, p.y, p.z]).collect());
            let share = 1.0 / subject.before.len() as f64;
            ends.cpu += share * done.cpu_seconds;
            ends.two_way_steps += share * done.two_way_steps as f64;
            ends.stretch = ends.stretch.max(done.max_stretch);
            ends.met += usize::from(done.converged);
            ends.intersections += report.intersection_count;
        }
        Ok(ends)
    })
}

/// The states before the compared time steps, under the scene's own settings.
fn states(bench: &Bench, subject: &Subject) -> Result<Vec<Checkpoint>> {
    let mut simulator = Simulator::new(&scene(bench, subject, &[])?)?;
    let mut states = Vec::new();
    for before in subject.before {
        while simulator.step_index() < before {
            simulator.step()?;
        }
        states.push(simulator.checkpoint());
    }
    Ok(states)
}
