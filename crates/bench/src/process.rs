//! Simulations in processes of their own, because a process reports only its own peak of memory: by this
//! command, or by a `bowknot` of another commit.

use anyhow::{Context, Result, ensure};
use bowknot::run::{self, RunOptions};
use bowknot::simulator::{StepSeconds, peak_memory_bytes};
use bowknot::{Scene, Simulator};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
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

/// A part of a run that is continued until it is at its end, and judged.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// A built-in scene.
    pub scene: &'static str,
    pub scale: f64,
    /// Number of time steps of the whole run.
    pub frames: usize,
    /// Time step [s].
    pub dt: f64,
    /// Longest time of this part [s].
    pub seconds: f64,
}

impl Part {
    /// Computes it in another process of this command; `folder` holds the run.
    pub fn run(&self, folder: &Path) -> Result<()> {
        let output = Command::new(env::current_exe()?)
            .args(["simulate", "--of", self.scene])
            .args(["--scale", &self.scale.to_string()])
            .args(["--frames", &self.frames.to_string()])
            .args(["--threads", &rayon::current_num_threads().to_string()])
            .args(["--dt", &self.dt.to_string()])
            .args(["--seconds", &self.seconds.to_string()])
            .arg("--folder")
            .arg(folder)
            .output()
            .context("cannot start another process of this command")?;
        ensure!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Ok(())
    }
}

/// The work of another process of this command for a [`Part`]: begins or continues the run in `folder`.
pub fn continue_run(of: (&str, f64), frames: usize, dt: f64, seconds: f64, folder: &Path) -> Result<()> {
    let deadline = Instant::now() + Duration::from_secs_f64(seconds.max(0.0));
    let sets = [
        format!("simulation.dt={dt}"),
        format!("simulation.frames={frames}"),
        "output.formats=[\"pc2\"]".to_owned(),
    ];
    let scene = Scene::builtin(of.0, of.1)?.with_sets(&sets)?;
    let resume = folder.join("checkpoint/state.npz").exists();
    if !resume && folder.exists() {
        // What a process has left that was killed before its first checkpoint.
        fs::remove_dir_all(folder).with_context(|| format!("cannot remove {}", folder.display()))?;
    }
    let options = RunOptions { out: folder.to_owned(), resume, check: true, ..RunOptions::default() };
    run::run(&scene, &options, &mut |_| {
        if Instant::now() < deadline { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    })?;
    Ok(())
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
