//! What all figures use: the size of a run, where its results go, and what has been measured already.

use crate::figures::{Figure, Part, Section};
use crate::machine::Machine;
use crate::store::Store;
use crate::{chart, page};
use anyhow::{Context, Result};
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// For docs/benchmarks.md: each figure within 20 minutes.
    Full,
    /// A look: all figures together within 10 minutes.
    Quick,
    /// For tests of the command.
    Tiny,
}

impl Size {
    /// The one of three that belongs to the size.
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
    machine: Machine,
    out: PathBuf,
    /// When the run began.
    begun: Instant,
    /// When the present figure began.
    started: Cell<Instant>,
    /// Whether something was left out for want of time.
    short: Cell<bool>,
}

impl Bench {
    /// A run that keeps its results in `out`, apart for each size.
    pub fn new(size: Size, out: &Path) -> Result<Self> {
        let machine = Machine::now(&repository());
        let out = out.join(size.name());
        fs::create_dir_all(&out).with_context(|| format!("cannot create {}", out.display()))?;
        Ok(Self {
            size,
            store: Store::new(&out.join("measured"), &machine.commit),
            machine,
            out,
            begun: Instant::now(),
            started: Cell::new(Instant::now()),
            short: Cell::new(false),
        })
    }

    /// Folder of all results of this size.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// Whether the present figure may measure more. Once it may not, what is missing is left out and the figure says so;
    /// another run of the command goes on from there.
    pub fn has_time(&self) -> bool {
        let seconds = self.size.pick(17 * 60, 60, 15);
        // All quick figures together have ten minutes; what is recorded or begun late is in the rest.
        let late = self.size != Size::Full && self.begun.elapsed() > Duration::from_secs(8 * 60);
        let left = self.started.get().elapsed() < Duration::from_secs(seconds) && !late;
        if !left {
            self.short.set(true);
        }
        left
    }

    /// Measures a figure and writes its tables and charts; in a full run also its section of the page.
    pub fn figure(&self, figure: &dyn Figure) -> Result<()> {
        let clock = Instant::now();
        self.started.set(clock);
        self.short.set(false);
        self.store.take_commits();
        let load = Machine::load();
        println!("{}: {}", figure.name(), figure.title());
        let section = figure.run(self).with_context(|| format!("figure {}", figure.name()))?;
        let folder = self.out.join(figure.name());
        write_parts(&section, &folder, true)?;
        println!("  {}\n  {:.0} s, {}", section.finding, clock.elapsed().as_secs_f64(), folder.display());
        let conditions = self.conditions(&load);
        let text = page::section(figure, &section, &conditions);
        write(&folder.join("section.md"), &text)?;
        if self.size == Size::Full {
            let docs = repository().join("docs");
            write_parts(&section, &docs.join("benchmarks"), false)?;
            page::rewrite(&docs.join("benchmarks.md"), figure.name(), &text)?;
        }
        Ok(())
    }

    /// What the figures were measured with, one line.
    fn conditions(&self, load: &str) -> String {
        let Machine { cores, cpu, .. } = &self.machine;
        let mut commits = self.store.take_commits().join(", ");
        if commits.is_empty() {
            commits.clone_from(&self.machine.commit);
        }
        let threads = match rayon::current_num_threads() {
            1 => "1 thread".to_owned(),
            n => format!("{n} threads"),
        };
        let short = if self.short.get() { " Out of time: what is missing was not measured." } else { "" };
        format!(
            "Commit {commits}; {threads} of {cores} cores, {cpu}; load average {load} before, {} after.{short}",
            Machine::load()
        )
    }
}

/// Tables as CSV, charts as SVG.
fn write_parts(section: &Section, folder: &Path, tables: bool) -> Result<()> {
    for part in &section.parts {
        match part {
            Part::Table { name, table, .. } | Part::Data { name, table } if tables => {
                write(&folder.join(format!("{name}.csv")), &table.csv())?;
            }
            Part::Chart { name, chart } => {
                write(&folder.join(format!("{name}.svg")), &chart::svg(chart))?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// Writes a file and the folder it is in.
pub fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).with_context(|| format!("cannot create {}", parent.display()))?;
    }
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}

/// Where the page is: the repository that the command was built from.
fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
