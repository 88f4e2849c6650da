//! What is run, in both sizes, and what it is held against.

use super::command::{Bench, Run, RunSpec, Size};
use std::path::PathBuf;

/// A scene whose collision problems are recorded and replayed.
pub struct Recorded {
    pub name: &'static str,
    pub run: Run,
    /// Some of the recorded problems, spread evenly over the time steps in contact.
    pub states: Vec<PathBuf>,
    pub vertices: f64,
    /// Steps of `paper` over those of `fast`: at least, aim.
    pub goal: (f64, f64),
    /// Steps that the prototype took: `paper`, `fast`.
    pub prototype: (&'static str, &'static str),
}

/// CPU seconds of `paper` over those of `fast`, of any recorded scene: at least, aim.
pub const CPU_GOAL: (f64, f64) = (8.0, 20.0);

/// Lengths for the contact distance delta.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lengths {
    /// 1 mm, as in the paper's Table 3.
    Paper,
    /// A tenth of the mean edge length: 2 mm here.
    Default,
}

impl Lengths {
    /// Options of `run` and `resolve`.
    pub fn options(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &["--set", "contact.delta=0.001"],
            Self::Default => &[],
        }
    }
}

/// Runs needle, stack and tube and picks `count` problems of each.
pub fn recorded(bench: &Bench, lengths: Lengths, count: usize) -> Result<Vec<Recorded>, String> {
    let goals = [(15.0, 60.0), (12.0, 20.0), (8.0, 11.0)];
    let prototypes = [("636 (2,048)", "10.6 (15)"), ("183 (388)", "9.3 (10)"), ("47 (116)", "4.3 (6)")];
    let specs = specs(bench.size, lengths);
    let mut all = Vec::new();
    for ((spec, goal), prototype) in specs.iter().zip(goals).zip(prototypes) {
        let run = bench.run(spec)?;
        let states = in_contact(&run, count);
        if states.is_empty() {
            return Err(format!("no contact in {} frames of {}", spec.frames, spec.scene));
        }
        let vertices = run.of("vertices");
        all.push(Recorded { name: spec.scene, run, states, vertices, goal, prototype });
    }
    Ok(all)
}

fn specs(size: Size, lengths: Lengths) -> [RunSpec; 3] {
    let names = match lengths {
        Lengths::Paper => ["needle-1mm", "stack-1mm", "tube-1mm"],
        Lengths::Default => ["needle", "stack", "tube"],
    };
    // Scales give the sizes of the prototype's scenes: 2.8k, 8.8k and 5.2k vertices.
    let sizes = match size {
        Size::Full => [(0.52, 40), (1.0, 120), (0.45, 150)],
        Size::Quick => [(0.3, 20), (0.4, 50), (0.25, 90)],
    };
    let options: &[&str] = match lengths {
        Lengths::Paper => &["--record", "--set", "contact.delta=0.001"],
        Lengths::Default => &["--record"],
    };
    let scenes = ["needle", "stack", "tube"];
    std::array::from_fn(|k| {
        let (scale, frames) = sizes[k];
        RunSpec { name: names[k], scene: scenes[k], scale, frames, threads: 2, options }
    })
}

/// Problems of time steps with contact rows, each in the middle of an equal share of them.
fn in_contact(run: &Run, count: usize) -> Vec<PathBuf> {
    let rows = run.each(&["contact_rows"]);
    let steps: Vec<usize> = (0..rows.len()).filter(|&k| rows[k] > 0.0).map(|k| k + 1).collect();
    let count = count.min(steps.len());
    (0..count).map(|k| run.state(steps[(2 * k + 1) * steps.len() / (2 * count)])).collect()
}

/// The needle of the paper's size.
pub fn needle(size: Size) -> RunSpec {
    let (scale, frames) = if size == Size::Full { (1.0, 40) } else { (0.5, 12) };
    RunSpec { name: "needle-10k", scene: "needle", scale, frames, threads: 2, options: &[] }
}

/// The README's scene.
pub fn drape(size: Size) -> RunSpec {
    let (scale, frames) = if size == Size::Full { (1.0, 100) } else { (0.5, 40) };
    RunSpec { name: "drape", scene: "drape", scale, frames, threads: 2, options: &[] }
}

/// Next to nothing: what a process takes before it has a scene.
pub fn tiny() -> RunSpec {
    RunSpec { name: "tiny", scene: "drape", scale: 0.05, frames: 1, threads: 2, options: &[] }
}

/// 50,000 vertices that fly for nine time steps and then meet a ball.
pub fn sphere(size: Size, threads: usize) -> RunSpec {
    let (scale, frames) = if size == Size::Full { (1.0, 20) } else { (0.4, 14) };
    let name = if threads == 1 { "sphere-1" } else { "sphere-2" };
    RunSpec { name, scene: "sphere", scale, frames, threads, options: &[] }
}
