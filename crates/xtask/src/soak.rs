//! `cargo xtask soak`: draws collision problems for minutes or hours, and judges each accepted step.
//!
//! The problems are those of the package `bowknot-safety`, whose tests draw some with fixed seeds.

use crate::workspace::cargo;
use std::path::Path;
use std::process::ExitCode;

/// Builds and runs the example `soak` with these options, which it reads itself.
pub fn run(root: &Path, options: &[&str]) -> ExitCode {
    let mut command = cargo(root, "run --quiet --release --package bowknot-safety --example soak --");
    match command.args(options).status() {
        Ok(status) => u8::try_from(status.code().unwrap_or(1)).map_or(ExitCode::FAILURE, ExitCode::from),
        Err(error) => {
            eprintln!("cannot start cargo: {error}");
            ExitCode::FAILURE
        }
    }
}
