//! Simulations in processes of their own, because a process reports only its own peak of memory: by this
//! command, or by a `bowknot` of another commit.

use anyhow::{Context, Result, ensure};
use bowknot::simulator::{StepSeconds, peak_memory_bytes};
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;
use std::{env, fs, process};

/// What is simulated.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// A built-in scene.
    pub scene: &'static str,
    pub scale: f64,
    pub frames: usize,
    pub threads: usize,
}

/// A simulation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ProcessRun {
    /// Largest resident memory.
    pub bytes: u64,
    /// Deformable vertices.
    pub vertices: usize,
    pub steps: Vec<TimeStep>,
}

/// A time step: those entries of `stats.jsonl` that figures use.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TimeStep {
    pub two_way_steps: usize,
    pub contacts: usize,
    pub cg_iterations: usize,
    pub seconds: StepSeconds,
}

impl Case {
    /// Names the case, for kept measurements.
    pub fn key(&self) -> String {
        format!("{}-{}-{}-{}", self.scene, self.scale, self.frames, self.threads)
    }

    /// Simulates in another process of this command.
    pub fn run(&self) -> Result<ProcessRun> {
        let output = Command::new(env::current_exe()?)
            .args(["simulate", "--of", self.scene])
            .args(["--scale", &self.scale.to_string()])
            .args(["--frames", &self.frames.to_string()])
            .args(["--threads", &self.threads.to_string()])
            .output()
            .context("cannot start another process of this command")?;
        ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Ok(serde_json::from_slice(&output.stdout)?)
    }

    /// Simulates with the program `bowknot` at that path; `folder` is for its results, which are removed.
    pub fn run_with(&self, bowknot: &Path, folder: &Path) -> Result<ProcessRun> {
        let folder = folder.join(format!("run-{}", process::id()));
        let output = Command::new(bowknot)
            .args(["run", self.scene, "--quiet", "--scale", &self.scale.to_string()])
            .args(["--frames", &self.frames.to_string(), "--threads", &self.threads.to_string()])
            .arg("--out")
            .arg(&folder)
            .output()
            .with_context(|| format!("cannot start {}", bowknot.display()))?;
        ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let read = |name: &str| -> Result<String> {
            let path = folder.join(name);
            fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
        };
        let summary: Summary = serde_json::from_str(&read("summary.json")?)?;
        let steps = read("stats.jsonl")?.lines().map(serde_json::from_str).collect::<Result<_, _>>()?;
        fs::remove_dir_all(&folder).with_context(|| format!("cannot remove {}", folder.display()))?;
        Ok(ProcessRun { bytes: summary.peak_memory_bytes, vertices: summary.vertices, steps })
    }
}

/// The entries of `summary.json` that are used.
#[derive(Deserialize)]
struct Summary {
    vertices: usize,
    peak_memory_bytes: u64,
}

/// The work of another process of this command, in the present thread pool: prints its [`ProcessRun`] as
/// JSON.
pub fn print_run(scene: &str, scale: f64, frames: usize) -> Result<()> {
    let mut simulator = Simulator::new(&Scene::builtin(scene, scale)?)?;
    let mut steps = Vec::with_capacity(frames);
    for _ in 0..frames {
        let s = simulator.step()?;
        steps.push(TimeStep {
            two_way_steps: s.two_way_steps,
            contacts: s.contact_rows + s.pressing_contacts,
            cg_iterations: s.cg_iterations,
            seconds: s.seconds,
        });
    }
    let bytes = peak_memory_bytes().context("this system does not report the peak memory of a process")?;
    let vertices = simulator.world().deformable_vertices;
    println!("{}", serde_json::to_string(&ProcessRun { bytes, vertices, steps })?);
    Ok(())
}
