//! Developer commands: `cargo xtask check` runs everything that CI runs, `cargo xtask pictures` draws the scenes.
// A command for people and CI logs: printing is what it does.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod check;
mod docs;
mod pictures;
mod readers;

use std::process::ExitCode;

const USAGE: &str = "\
Usage: cargo xtask check [--fast]
       cargo xtask pictures [SCENE..]

check   run what CI runs, in named steps: format, clippy, docs, wasm, a small run, its exports read back, tests
        --fast   format, clippy and unit tests only
pictures run built-in scenes, all or those named, and draw them into assets/pictures: needs a graphics driver";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["check"] => check::run(false),
        ["check", "--fast"] => check::run(true),
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
