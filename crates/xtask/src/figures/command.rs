//! The command `bowknot` as the thing that is measured.

use super::json::number;
use super::table::median;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// A minute or two: shows that everything works.
    Quick,
    /// The figures of the documentation.
    Full,
}

/// A whole run.
#[derive(Clone, Debug)]
pub struct RunSpec {
    /// Folder of its output.
    pub name: &'static str,
    pub scene: &'static str,
    pub scale: f64,
    pub frames: usize,
    pub threads: usize,
    /// Further options.
    pub options: &'static [&'static str],
}

/// What a run left.
#[derive(Clone, Debug)]
pub struct Run {
    pub folder: PathBuf,
    /// Lines of `stats.jsonl`, one a time step.
    pub steps: Vec<String>,
    pub summary: String,
}

impl Run {
    /// One number of each time step; steps without it are left out.
    pub fn each(&self, path: &[&str]) -> Vec<f64> {
        self.steps.iter().filter_map(|line| number(line, path)).collect()
    }

    pub fn sum(&self, path: &[&str]) -> f64 {
        self.each(path).iter().sum()
    }

    pub fn of(&self, key: &str) -> f64 {
        number(&self.summary, &[key]).unwrap_or(f64::NAN)
    }

    /// The recorded collision problem of a time step, counted from 1.
    pub fn state(&self, step: usize) -> PathBuf {
        self.folder.join("states").join(format!("{step:06}_00.npz"))
    }
}

/// How a recorded problem is resolved.
#[derive(Clone, Debug)]
pub struct Variant {
    pub name: String,
    pub arguments: Vec<String>,
}

impl Variant {
    pub fn new(name: &str, arguments: &str) -> Self {
        let arguments = arguments.split_whitespace().map(str::to_owned).collect();
        Self { name: name.to_owned(), arguments }
    }

    /// The same with further options.
    pub fn with(mut self, options: &[&str]) -> Self {
        self.arguments.extend(options.iter().map(|&s| s.to_owned()));
        self
    }
}

/// What `resolve --json` says.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    pub steps: f64,
    pub searches: f64,
    pub cpu_seconds: f64,
    pub distance_mm: f64,
    pub remaining_mm: f64,
    pub stretch: f64,
    /// Infinite if no pair is in reach.
    pub gap_mm: f64,
    pub converged: bool,
}

/// Calls longer than this are not repeated [s].
const LONG: f64 = 2.0;

/// The command, and where its output goes.
pub struct Bench {
    root: PathBuf,
    binary: PathBuf,
    out: PathBuf,
    pub size: Size,
    /// Runs are made once, whichever section asks first.
    runs: RefCell<BTreeMap<&'static str, Run>>,
}

impl Bench {
    /// Builds the command and copies it to the output folder.
    pub fn new(root: &Path, target: &Path, out: &Path, size: Size) -> Result<Self, String> {
        let in_folder = |error| format!("cannot write to {}: {error}", out.display());
        std::fs::create_dir_all(out.join("runs")).map_err(in_folder)?;
        let out = &out.canonicalize().map_err(in_folder)?;
        cargo(root, &["build", "--release", "--package", "bowknot-cli"])?;
        let name = format!("bowknot{}", std::env::consts::EXE_SUFFIX);
        let binary = out.join(&name);
        std::fs::copy(target.join("release").join(&name), &binary)
            .map_err(|error| format!("cannot copy the command to {}: {error}", out.display()))?;
        let bench = Self { root: root.to_owned(), binary, out: out.clone(), size, runs: RefCell::default() };
        bench.write("replays.csv", "state,variant,repeat,steps,searches,cpu_seconds,converged\n")?;
        Ok(bench)
    }

    /// Makes a run, or returns it if it was made before.
    pub fn run(&self, spec: &RunSpec) -> Result<Run, String> {
        if let Some(run) = self.runs.borrow().get(spec.name) {
            return Ok(run.clone());
        }
        let run = self.run_again(spec)?;
        self.runs.borrow_mut().insert(spec.name, run.clone());
        Ok(run)
    }

    /// Makes a run in any case.
    pub fn run_again(&self, spec: &RunSpec) -> Result<Run, String> {
        let folder = self.out.join("runs").join(spec.name);
        // Of an earlier measurement: only what holds a run is removed.
        if folder.join("stats.jsonl").is_file() {
            std::fs::remove_dir_all(&folder)
                .map_err(|error| format!("cannot remove {}: {error}", folder.display()))?;
        }
        let (scale, frames, threads) =
            (spec.scale.to_string(), spec.frames.to_string(), spec.threads.to_string());
        let mut command = Command::new(&self.binary);
        command.args(["run", spec.scene, "--quiet", "--scale", &scale, "--frames", &frames]);
        command.args(["--threads", &threads]).args(spec.options).arg("--out").arg(&folder);
        println!("run {} --scale {scale} --frames {frames} {}", spec.scene, spec.options.join(" "));
        output(&mut command)?;
        let read = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))
        };
        let (steps, summary) = (read("stats.jsonl")?, read("summary.json")?);
        Ok(Run { steps: steps.lines().map(str::to_owned).collect(), summary, folder })
    }

    /// Resolves each state by each variant in turn; the result is indexed by variant, then state. CPU seconds are
    /// medians of `repeats` calls where these are short.
    pub fn replay(
        &self,
        states: &[PathBuf],
        variants: &[Variant],
        repeats: usize,
    ) -> Result<Vec<Vec<Outcome>>, String> {
        let mut outcomes = vec![vec![Outcome::default(); states.len()]; variants.len()];
        let mut times = vec![vec![Vec::new(); states.len()]; variants.len()];
        let mut log = String::new();
        for repeat in 0..repeats {
            for (s, state) in states.iter().enumerate() {
                for (v, variant) in variants.iter().enumerate() {
                    if times[v][s].first().is_some_and(|&t| t > LONG) {
                        continue;
                    }
                    let outcome = self.resolve(state, variant)?;
                    let shown = state.strip_prefix(&self.out).unwrap_or(state).display();
                    let Outcome { steps, searches, cpu_seconds, converged, .. } = outcome;
                    let _ = writeln!(
                        log,
                        "{shown},{},{repeat},{steps},{searches},{cpu_seconds:.4},{converged}",
                        variant.name.replace(',', "")
                    );
                    times[v][s].push(cpu_seconds);
                    outcomes[v][s] = Outcome { cpu_seconds: median(&times[v][s]), ..outcome };
                }
            }
        }
        self.append("replays.csv", &log)?;
        Ok(outcomes)
    }

    fn resolve(&self, state: &Path, variant: &Variant) -> Result<Outcome, String> {
        let mut command = Command::new(&self.binary);
        command.arg("resolve").arg(state).arg("--out").arg(self.out.join("result.npz"));
        command.args(["--json", "--threads", "2"]).args(&variant.arguments);
        let text = output(&mut command)?;
        let get = |key: &str| number(&text, &[key]).ok_or_else(|| format!("no {key} in {text}"));
        Ok(Outcome {
            steps: get("steps")?,
            searches: get("searches")?,
            cpu_seconds: get("cpu_seconds")?,
            distance_mm: 1e3 * get("distance_to_target")?,
            remaining_mm: 1e3 * get("remaining_m")?,
            stretch: get("max_step_stretch")?,
            gap_mm: get("min_gap_m").map_or(f64::INFINITY, |gap| 1e3 * gap),
            converged: get("converged")? > 0.0,
        })
    }

    /// Runs an example of the workspace and returns what it prints.
    pub fn example(&self, package: &str, example: &str, arguments: &[PathBuf]) -> Result<String, String> {
        let mut command = Command::new(cargo_path());
        command.args(["run", "--quiet", "--release", "--package", package, "--example", example, "--"]);
        output(command.args(arguments).current_dir(&self.root))
    }

    /// Writes a file of the output folder.
    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        let path = self.out.join(name);
        std::fs::write(&path, text).map_err(|error| format!("cannot write {}: {error}", path.display()))
    }

    fn append(&self, name: &str, text: &str) -> Result<(), String> {
        let mut whole = std::fs::read_to_string(self.out.join(name)).unwrap_or_default();
        whole.push_str(text);
        self.write(name, &whole)
    }
}

fn cargo_path() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

fn cargo(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let status = Command::new(cargo_path()).args(arguments).current_dir(root).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(_) => Err(format!("cargo {} failed", arguments.join(" "))),
        Err(error) => Err(format!("cannot start cargo: {error}")),
    }
}

/// Standard output of a command that must succeed.
fn output(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("cannot start {command:?}: {error}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(format!("{command:?} failed: {}", String::from_utf8_lossy(&output.stderr).trim()))
    }
}
