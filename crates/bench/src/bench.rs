//! What all figures use: the size of a run, its folder, what is measured already, and how much time is left.

use crate::machine::Machine;
use crate::store::Store;
use anyhow::{Context, Result};
use bowknot_errors::counted;
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time that a full figure has for its measurements, without the recording of its problems [s].
pub const FULL_SECONDS: u64 = 17 * 60;

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// For docs/benchmarks: each figure within 20 minutes, beside the recording of its problems.
    Full,
    /// A preview: all figures together within 10 minutes.
    Quick,
    /// For tests of the command.
    Tiny,
}

impl Size {
    /// The value for this size.
    pub fn pick<T>(self, full: T, quick: T, tiny: T) -> T {
        match self {
            Self::Full => full,
            Self::Quick => quick,
            Self::Tiny => tiny,
        }
    }

    fn name(self) -> &'static str {
        self.pick("full", "quick", "tiny")
    }
}

/// One run of the command.
#[derive(Debug)]
pub struct Bench {
    pub size: Size,
    pub store: Store,
    /// A program `bowknot` of an older commit, to compare with.
    pub before: Option<PathBuf>,
    /// A part of the names of the cases that are wanted; none: all are.
    pub cases: Option<String>,
    machine: Machine,
    out: PathBuf,
    /// When the run began.
    run_timer: Instant,
    /// When the present figure began, later by the time that its problems were recorded.
    figure_timer: Cell<Instant>,
    /// Whether something was left out for lack of time.
    out_of_time: Cell<bool>,
}

impl Bench {
    /// A run of the code in `repository` that keeps its results in a folder per size in `out`.
    pub fn new(size: Size, out: &Path, repository: &Path, before: Option<PathBuf>) -> Result<Self> {
        let machine = Machine::now(repository);
        let out = out.join(size.name());
        fs::create_dir_all(&out).with_context(|| format!("cannot create {}", out.display()))?;
        Ok(Self {
            size,
            store: Store::new(&out.join("measured"), &machine.commit),
            before,
            cases: None,
            machine,
            out,
            run_timer: Instant::now(),
            figure_timer: Cell::new(Instant::now()),
            out_of_time: Cell::new(false),
        })
    }

    /// Folder of all results of this size.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// Whether the case of that name is wanted.
    pub fn wants(&self, name: &str) -> bool {
        self.cases.as_ref().is_none_or(|part| name.contains(part.as_str()))
    }

    /// Whether that case alone is wanted.
    pub fn asks_for(&self, name: &str) -> bool {
        self.cases.as_deref() == Some(name)
    }

    /// Starts the time of a figure.
    pub fn begin_figure(&self) {
        self.figure_timer.set(Instant::now());
        self.out_of_time.set(false);
        self.store.take_commits();
        self.store.take_references();
    }

    /// Records problems, which takes nothing of a full figure's time: what it measures must not depend on whether they
    /// are there.
    pub fn recorded<T>(&self, record: impl FnOnce() -> T) -> T {
        let timer = Instant::now();
        let result = record();
        if self.size == Size::Full {
            self.figure_timer.set(self.figure_timer.get() + timer.elapsed());
        }
        result
    }

    /// Seconds since the present figure began, if full without recordings.
    pub fn figure_seconds(&self) -> f64 {
        self.figure_timer.get().elapsed().as_secs_f64()
    }

    /// Whether the present figure may measure more. If not, what is missing is left out and the figure says
    /// so; another run of the command continues from there.
    pub fn has_time(&self) -> bool {
        let seconds = self.size.pick(FULL_SECONDS, 60, 15);
        // All quick figures together have ten minutes; recordings and figures that began late take the rest.
        let late = self.size != Size::Full && self.run_timer.elapsed() > Duration::from_secs(9 * 60);
        let left = self.figure_timer.get().elapsed() < Duration::from_secs(seconds) && !late;
        if !left {
            self.out_of_time.set(true);
        }
        left
    }

    /// The commits of the present figure's measurements, and the machine, in one line. `load` is the load
    /// average before the figure.
    pub fn conditions(&self, load: &str) -> String {
        let Machine { cores, cpu, .. } = &self.machine;
        let mut commits = self.store.take_commits().join(", ");
        if commits.is_empty() {
            commits.clone_from(&self.machine.commit);
        }
        let references = self.store.take_references();
        if !references.is_empty() {
            commits += &format!("; references of {}", references.join(", "));
        }
        let threads = counted(rayon::current_num_threads(), "thread", "threads");
        let missing = if self.out_of_time.get() { " Out of time: the rest was not measured." } else { "" };
        format!(
            "Commit {commits}; {threads} of {cores} cores, {cpu}; load average {load} before, {} \
             after.{missing}",
            Machine::load()
        )
    }
}
