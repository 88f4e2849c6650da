//! Developer commands: `cargo xtask check` runs everything that CI runs, `cargo xtask figures` measures.
// A command for people and CI logs: printing is what it does.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod check;
mod docs;
mod figures;
mod pictures;
mod readers;

use std::process::ExitCode;

const USAGE: &str = "\
Usage: cargo xtask check [--fast]
       cargo xtask figures [--quick] [--out DIR]
       cargo xtask pictures [SCENE..]

check   run what CI runs, in named steps: format, clippy, docs, wasm, a small run, its exports read back, tests
        --fast   format, clippy and unit tests only
figures measure and rewrite docs/figures.md: some ten minutes, best on an idle machine
        --quick  smaller scenes, the page goes to DIR
        --out    folder for runs and single measurements [default: target/xtask/figures]
pictures run built-in scenes, all or those named, and draw them into docs/pictures: needs a graphics driver";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["check"] => check::run(false),
        ["check", "--fast"] => check::run(true),
        ["figures", rest @ ..] if let Some(options) = figures::Options::parse(rest) => figures::run(&options),
        ["pictures", names @ ..] if names.iter().all(|name| !name.starts_with('-')) => {
            pictures::run(&check::root(), names)
        }
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
