//! `cargo xtask miri`: unit tests under Miri.
//!
//! Miri interprets programs and finds undefined behavior: reads out of bounds, broken aliasing, data races.
//! It is hundreds of times slower than a release build, so only unit tests of crates with `unsafe` of their
//! own, and of those that index the most, run under it.

use crate::nightly;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The crates that are tested if none is named.
const CRATES: [&str; 3] = ["geometry", "lcp", "stepper"];

/// Runs the unit tests of `crates`, of [`CRATES`] if there are none.
pub fn run(root: &Path, crates: &[&str]) -> ExitCode {
    let mut command = command(root, if crates.is_empty() { &CRATES } else { crates });
    match command.status() {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        Ok(_) => {
            eprintln!(
                "Miri failed. If it is missing: rustup toolchain install nightly --component miri \
                 --component rust-src"
            );
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("cannot start cargo: {error}");
            ExitCode::FAILURE
        }
    }
}

fn command(root: &Path, crates: &[&str]) -> Command {
    let mut command = nightly::cargo(root);
    command.args(["miri", "test", "--lib"]);
    for name in crates {
        command.arg("--package").arg(format!("bowknot-{name}"));
    }
    // Tests on many threads do not end within a quarter of an hour.
    command.args(["--", "--skip", "threads"]);
    // Random tests read the clock for their seed, and rayon's queue is sound but not under stacked borrows.
    command.env("MIRIFLAGS", "-Zmiri-disable-isolation -Zmiri-tree-borrows -Zmiri-ignore-leaks");
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_named() {
        let command = command(Path::new("."), &CRATES);
        let words: Vec<_> = command.get_args().map(|word| word.to_string_lossy()).collect();
        let packages =
            "miri test --lib --package bowknot-geometry --package bowknot-lcp --package bowknot-stepper --";
        assert!(words.join(" ").contains(packages));
    }
}
