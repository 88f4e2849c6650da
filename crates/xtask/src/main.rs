//! Developer commands: `cargo xtask check` runs everything that CI runs.
// A command for people and CI logs: printing is what it does.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod check;
mod docs;

use std::process::ExitCode;

const USAGE: &str = "\
Usage: cargo xtask check [--fast]

check   run what CI runs, in named steps: format, clippy, docs, wasm, a small run, tests
        --fast   format, clippy and unit tests only";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["check"] => check::run(false),
        ["check", "--fast"] => check::run(true),
        ["help" | "--help" | "-h"] => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("{USAGE}");
            ExitCode::from(2)
        }
    }
}
