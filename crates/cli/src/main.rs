//! The `bowknot` command: arguments, messages and exit codes around the library.
//!
//! Results go to stdout; progress, warnings and errors to stderr.
// A command prints its results.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod archive;
mod args;
mod bare_mesh;
mod check;
mod dump;
mod exit;
mod export;
mod failure_dump;
mod fault;
mod gpu;
mod hints;
mod info;
mod interrupt;
mod near_starts;
mod output;
mod pages;
mod progress;
#[cfg(feature = "render")]
mod render;
mod repair;
mod report;
mod resolve;
mod run;
mod scenes;
mod setup;
mod sizes;

use args::{Arguments, Command};
use clap::Parser;
use exit::{Exit, Failure};
use std::process::ExitCode;

fn main() -> ExitCode {
    // With a wrong option clap prints a message and exits with code 2.
    let arguments = Arguments::parse();
    #[cfg(all(any(feature = "gpu", feature = "render"), target_os = "linux"))]
    setup::no_display();
    setup::logging(matches!(&arguments.command, Command::Run(options) if options.quiet));
    let result = fault::guarded(|| match arguments.command {
        Command::Scenes(options) => scenes::scenes(&options),
        Command::Run(options) => run::run(&options),
        Command::Resolve(options) => resolve::resolve(&options),
        Command::Check(options) => check::check(&options),
        Command::Repair(options) => repair::repair(&options),
        Command::Export(options) => export::export(&options),
        Command::Report(options) => report::report(&options),
        #[cfg(feature = "render")]
        Command::Render(options) => render::render(&options),
        Command::Info(options) => info::info(&options),
        Command::Completions(options) => pages::completions(&options),
        Command::Man(options) => pages::man(&options),
    });
    match result {
        Ok(Exit::Success) => ExitCode::SUCCESS,
        Ok(Exit::CheckFailed) => ExitCode::from(1),
        Ok(Exit::Interrupted) => ExitCode::from(130),
        Err(Failure { code, message }) => {
            eprintln!("error: {message}");
            ExitCode::from(code)
        }
    }
}
