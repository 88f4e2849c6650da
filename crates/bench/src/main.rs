//! The `bowknot-bench` command: measures figures and tables, run time against error, methods against each
//! other.
//!
//! | module | holds |
//! |---|---|
//! | `figures` | one file per figure or table |
//! | `figure` | the trait that they implement, and what they report |
//! | `run`, `durations` | measuring a figure; how long that takes |
//! | `docs`, `page`, `pages` | writing its results into docs/benchmarks and docs/benchmarks.md |
//! | `age`, `front` | which results on the pages are stale; the first section, from the tables of the others |
//! | `bench`, `store`, `machine` | size, folder and time of a run; kept measurements; machine, commit |
//! | `record`, `case`, `targets` | collision problems: recorded from scenes, loaded to be solved |
//! | `methods`, `solve` | the methods that are compared; timing one on one problem |
//! | `simulate`, `process` | whole simulations and the distances between them; simulations in other processes |
//! | `summary`, `over_fast` | results of settings on the problems of scenes; methods over `fast` |
//! | `stability` | small scenes at the ends of what users ask for, under the judge |
//! | `measures` | the quality of a result, measured alike for every method |
//! | `chart`, `table` | SVG, CSV and Markdown |
//!
//! Scripts in `crates/bench/peers` time other people's programs beside Bowknot and write block `peers` of the
//! page.

// A command prints its results.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod age;
mod bench;
mod case;
mod chart;
mod docs;
mod durations;
mod figure;
mod figures;
mod files;
mod front;
mod git;
mod machine;
mod measures;
mod methods;
mod over_fast;
mod page;
mod pages;
mod process;
mod record;
mod run;
mod simulate;
mod solve;
mod stability;
mod store;
mod summary;
mod table;
mod targets;

use anyhow::{Result, bail};
use bench::{Bench, Size};
use clap::Parser;
use docs::Docs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measures figures and tables. Full runs write docs/benchmarks.md and docs/benchmarks, from a clean git tree
/// only.
#[derive(Debug, Parser)]
#[command(name = "bowknot-bench")]
struct Arguments {
    /// A figure, `all`, `record` (collision problems as NPZ files), `list`, or `age` (marks stale results on the pages and writes
    /// the first section anew).
    name: String,
    /// Measures smaller scenes and writes to DIR alone.
    #[arg(long)]
    quick: bool,
    /// Measures the smallest scenes, for tests of the command itself; else as --quick.
    #[arg(long, hide = true)]
    tiny: bool,
    /// Folder of problems, measurements and results. Measurements that are there are not made again.
    #[arg(long, default_value = "out/bench")]
    out: PathBuf,
    /// Number of threads. With one, CPU seconds contain no waiting for other threads.
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// A program `bowknot` of an older commit: `goals` then compares with it.
    #[arg(long, value_name = "BOWKNOT")]
    before: Option<PathBuf>,
    /// Measures only the cases of `stability` whose names contain TEXT, and publishes nothing.
    #[arg(long, value_name = "TEXT")]
    cases: Option<String>,
    /// The scene of `simulate`, which the command runs in a process of its own.
    #[arg(long, hide = true, default_value = "drape")]
    of: String,
    /// Its scale.
    #[arg(long, hide = true, default_value_t = 1.0)]
    scale: f64,
    /// Its number of time steps.
    #[arg(long, hide = true, default_value_t = 1)]
    frames: usize,
    /// Its time step [s].
    #[arg(long, hide = true, default_value_t = 0.01)]
    dt: f64,
    /// The folder of a run that is continued for some seconds.
    #[arg(long, hide = true)]
    folder: Option<PathBuf>,
    /// These seconds.
    #[arg(long, hide = true, default_value_t = 60.0)]
    seconds: f64,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Names all figures, and how long they take.
fn list() -> Result<()> {
    let line = |name: &str, title: &str| {
        let (quick, full) = (durations::quick(name), durations::full(name));
        format!("{name:<23} {quick:>6} {full:>7}  {title}\n")
    };
    let mut text = format!("{:<23} {:>6} {:>7}\n", "name", "quick", "full");
    text.extend(figures::ALL.iter().map(|figure| line(figure.name(), figure.title())));
    let sets = record::PROBLEM_SETS.len();
    let scenes = record::contact_aware_scenes();
    let unaware = sets - scenes;
    let repelled = record::REPELLED.len();
    let problems = format!(
        "collision problems of {scenes} scenes in {} sets, as NPZ files: a set of each scene with \
         contact-aware targets, of {unaware} of them one with contact-unaware targets too, and of {repelled} one with \
         targets of the paper's repulsion",
        sets + repelled
    );
    text += &line("record", &problems);
    text += &format!(
        "\nquick, full: about the processor time of a first run with one thread; full is a limit without the \
         recording\nof problems, that of record a guess. Problems and measurements are kept, so that later runs take less. A figure stops \
         measuring after {}\nminutes and says so; run again, it goes on.\n",
        bench::FULL_SECONDS / 60
    );
    match std::io::stdout().write_all(text.as_bytes()) {
        // The reader, such as `head`, has seen enough.
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

fn run(arguments: &Arguments) -> Result<()> {
    if arguments.name == "list" {
        return list();
    }
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    if let ("simulate", Some(folder)) = (arguments.name.as_str(), &arguments.folder) {
        let Arguments { of, scale, frames, dt, seconds, .. } = arguments;
        return process::continue_run((of, *scale), *frames, *dt, *seconds, folder);
    }
    if arguments.name == "simulate" {
        return process::print_run(&arguments.of, arguments.scale, arguments.frames);
    }
    let size = match (arguments.tiny, arguments.quick) {
        (true, _) => Size::Tiny,
        (false, true) => Size::Quick,
        (false, false) => Size::Full,
    };
    // The repository that the command was built from.
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if arguments.name == "age" {
        return age::mark_pages(&repository);
    }
    let docs = Docs::new(&repository);
    if size == Size::Full && arguments.name != "record" && arguments.cases.is_none() {
        // Before hours of measurements, not after them.
        docs.ensure_clean()?;
    }
    let mut bench = Bench::new(size, &arguments.out, &repository, arguments.before.clone())?;
    bench.cases.clone_from(&arguments.cases);
    let names: Vec<&str> = figures::ALL.iter().map(|figure| figure.name()).collect();
    match arguments.name.as_str() {
        "record" => record::all(&bench),
        "all" => {
            // The first one, the overview, comes last: it shows what others have measured. A figure that fails does not
            // keep the others from being measured.
            let failed: Vec<String> = figures::ALL
                .iter()
                .cycle()
                .skip(1)
                .take(figures::ALL.len())
                .filter_map(|figure| run::measure(&bench, &docs, *figure, &names).err())
                .map(|error| format!("{error:#}"))
                .collect();
            if failed.is_empty() { Ok(()) } else { bail!("{}", failed.join("\n")) }
        }
        name => match figures::ALL.iter().find(|figure| figure.name() == name) {
            Some(figure) => run::measure(&bench, &docs, *figure, &names),
            None => bail!("no figure {name:?}; there are all, record, list, age, {}", names.join(", ")),
        },
    }
}
