//! The `bowknot-bench` command: measures figures and tables, run time against error, methods against each other.
//!
//! | module | holds |
//! |---|---|
//! | `figures` | a file for each figure or table |
//! | `bench` | what all of them use: size, output folder, what has been measured already |
//! | `record`, `case` | collision problems: recorded from scenes, loaded to be solved |
//! | `methods`, `solve` | the methods that are compared; timing one on one problem |
//! | `simulate`, `memory` | whole simulations, how far they are apart, what memory they take |
//! | `summary` | what settings did with the problems of scenes |
//! | `measures` | how good a result is, alike for every method |
//! | `chart`, `table`, `page` | SVG, CSV and Markdown |
//!
//! Other people's programs are timed beside Bowknot by scripts in `crates/bench/peers`, which write section `peers` of
//! the same page.

// A command's output is what it is for.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod bench;
mod case;
mod chart;
mod figures;
mod machine;
mod measures;
mod memory;
mod methods;
mod page;
mod record;
mod simulate;
mod solve;
mod store;
mod summary;
mod table;

use anyhow::{Result, bail};
use bench::{Bench, Size};
use clap::Parser;
use std::path::PathBuf;
use std::process::ExitCode;

/// Measures figures and tables; full runs rewrite their section of docs/benchmarks.md.
#[derive(Debug, Parser)]
#[command(name = "bowknot-bench")]
struct Arguments {
    /// A figure, `all`, `record` (collision problems for anyone's solver), or `list`.
    name: String,
    /// Smaller scenes; writes to DIR alone, and leaves docs/benchmarks.md as it is.
    #[arg(long)]
    quick: bool,
    /// Smallest scenes, for tests of the command itself; as --quick otherwise.
    #[arg(long, hide = true)]
    tiny: bool,
    /// Where problems, measurements and results stay; what is measured there already is not measured again.
    #[arg(long, default_value = "out/bench")]
    out: PathBuf,
    /// Threads; with one, CPU seconds hold no waiting for others.
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// The scene of `footprint`, which another process of this command asks for.
    #[arg(long, hide = true, default_value = "drape")]
    of: String,
    /// Its scale.
    #[arg(long, hide = true, default_value_t = 1.0)]
    scale: f64,
    /// Its time steps.
    #[arg(long, hide = true, default_value_t = 1)]
    frames: usize,
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

fn run(arguments: &Arguments) -> Result<()> {
    if arguments.name == "list" {
        for figure in figures::ALL {
            println!("{:<22} {}", figure.name(), figure.title());
        }
        println!("{:<22} collision problems in {} sets, as NPZ files", "record", record::SPECS.len());
        return Ok(());
    }
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    if arguments.name == "footprint" {
        return memory::print_footprint(&arguments.of, arguments.scale, arguments.frames);
    }
    let size = match (arguments.tiny, arguments.quick) {
        (true, _) => Size::Tiny,
        (false, true) => Size::Quick,
        (false, false) => Size::Full,
    };
    let bench = Bench::new(size, &arguments.out)?;
    match arguments.name.as_str() {
        "record" => record::all(&bench),
        "all" => {
            // One that fails keeps no other from being measured.
            let failed: Vec<String> = figures::ALL
                .iter()
                .filter_map(|figure| bench.figure(*figure).err())
                .map(|error| format!("{error:#}"))
                .collect();
            if failed.is_empty() { Ok(()) } else { bail!("{}", failed.join("\n")) }
        }
        name => match figures::ALL.iter().find(|figure| figure.name() == name) {
            Some(figure) => bench.figure(*figure),
            None => {
                let names: Vec<&str> = figures::ALL.iter().map(|figure| figure.name()).collect();
                bail!("no figure {name:?}; there are all, record, list, {}", names.join(", "))
            }
        },
    }
}
