//! `cargo xtask figures`: measures, and writes `docs/figures.md`.
//!
//! Everything goes through the command `bowknot`, built in release mode and copied first, so that a later build does not
//! change what is measured. Runs and single measurements stay in the folder of `--out`.

mod colours;
mod command;
mod json;
mod machine;
mod replays;
mod runs;
mod scenes;
mod switches;
mod table;

use command::{Bench, Size};
use machine::Machine;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// What to measure, and where to leave it.
#[derive(Debug, Default)]
pub struct Options {
    /// Smaller scenes; the page then goes to the output folder and the documentation stays.
    pub quick: bool,
    /// Folder for runs and single measurements.
    pub out: Option<PathBuf>,
}

impl Options {
    /// Reads what follows `figures` on the command line.
    pub fn parse(arguments: &[&str]) -> Option<Self> {
        let mut options = Self::default();
        let mut rest = arguments.iter();
        while let Some(&argument) = rest.next() {
            match argument {
                "--quick" => options.quick = true,
                "--out" => options.out = Some(PathBuf::from(rest.next()?)),
                _ => return None,
            }
        }
        Some(options)
    }
}

/// Measures everything and writes the page.
pub fn run(options: &Options) -> ExitCode {
    match measure(options) {
        Ok(page) => {
            println!("wrote {}", page.display());
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn measure(options: &Options) -> Result<PathBuf, String> {
    let clock = Instant::now();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("."));
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let out = options.out.clone().unwrap_or_else(|| target.join("xtask").join("figures"));
    let size = if options.quick { Size::Quick } else { Size::Full };
    let bench = Bench::new(root, &target, &out, size)?;
    let before = Machine::now(root);

    let mut sections = Vec::new();
    let mut section = |name: &str, make: &dyn Fn(&Bench) -> Result<String, String>| {
        println!("==> {name}");
        let text = make(&bench)?;
        println!("{text}");
        sections.push(format!("## {name}\n\n{text}"));
        Ok::<(), String>(())
    };
    section("Steps and CPU time of the presets", &replays::presets)?;
    section("Single switches", &switches::section)?;
    section("A needle of 10,000 vertices", &runs::needle)?;
    section("Time by stage", &runs::stages)?;
    section("Memory", &runs::memory)?;
    section("Free flight", &runs::free_flight)?;
    section("Two threads against one", &runs::threads)?;
    section("Colours", &colours::section)?;

    let head = before.describe(options.quick, clock.elapsed(), &Machine::load());
    let page = format!("{head}\n{}", sections.join("\n"));
    let path = match size {
        Size::Full => root.join("docs").join("figures.md"),
        Size::Quick => out.join("figures.md"),
    };
    std::fs::write(&path, page).map_err(|error| format!("cannot write {}: {error}", path.display()))?;
    Ok(path)
}
