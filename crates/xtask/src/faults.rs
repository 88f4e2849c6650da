//! `cargo xtask faults`: what runs and readers meet in the world, for longer than CI has time.
//!
//! The tests are those of CI, told by variables to try more: `crates/cli/tests/command/kills.rs` kills runs
//! at random moments, `faults.rs` beside it damages checkpoints and fills disks, `tests/tests/fuzz_files`
//! damages files.

use crate::workspace::cargo;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// What the command line asks for.
pub struct Options {
    kills: u32,
    seeds: u32,
}

impl Options {
    /// Reads `[--kills N] [--seeds N]`.
    pub fn parse(mut arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self { kills: 200, seeds: 20 };
        while let [name, rest @ ..] = arguments {
            let [value, rest @ ..] = rest else { return Err(format!("{name}: a value is missing")) };
            let number = value.parse().map_err(|_| format!("{name}: must be a whole number from 0 up"))?;
            match *name {
                "--kills" => options.kills = number,
                "--seeds" => options.seeds = number,
                _ => return Err(format!("faults: unknown argument {name}")),
            }
            arguments = rest;
        }
        Ok(options)
    }
}

/// Runs all, and goes on after a failure.
pub fn run(root: &Path, options: &Options) -> ExitCode {
    let kills = options.kills.to_string();
    let seeds = options.seeds.to_string();
    let tests = [
        (
            "kills",
            options.kills,
            "BOWKNOT_KILLS",
            &kills,
            "test --release -p bowknot-cli --test command -- kills:: --nocapture",
        ),
        (
            "faults",
            1,
            "BOWKNOT_KILLS",
            &kills,
            "test --release -p bowknot-cli --test command -- faults:: --nocapture",
        ),
        (
            "damaged folders",
            options.seeds,
            "BOWKNOT_SEEDS",
            &seeds,
            "test --release -p bowknot-cli --test command -- damaged_runs:: --nocapture",
        ),
        (
            "damaged files",
            options.seeds,
            "BOWKNOT_SEEDS",
            &seeds,
            "test --release -p bowknot-tests --test fuzz_files -- --nocapture",
        ),
    ];
    let mut failed = Vec::new();
    for (name, count, variable, value, arguments) in tests {
        if count == 0 {
            continue;
        }
        println!("==> {name}: {variable}={value} cargo {arguments}");
        let timer = Instant::now();
        let passed =
            cargo(root, arguments).env(variable, value).status().is_ok_and(|status| status.success());
        println!(
            "<== {name} {} after {:.1} s",
            if passed { "passed" } else { "failed" },
            timer.elapsed().as_secs_f64()
        );
        if !passed {
            failed.push(name);
        }
    }
    if failed.is_empty() {
        return ExitCode::SUCCESS;
    }
    eprintln!("failed: {}", failed.join(", "));
    ExitCode::FAILURE
}
