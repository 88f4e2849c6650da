//! The `bowknot` command: arguments, messages and exit codes around the facade.
//!
//! Results go to stdout; progress, warnings and errors to stderr.
// A command: printing is what it does.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod args;
mod check;
mod dump;
mod export;
mod failure;
mod info;
mod interrupt;
mod loose;
mod output;
mod progress;
#[cfg(feature = "render")]
mod render;
mod repair;
mod report;
mod resolve;
mod run;
mod scenes;
mod setup;

use args::{Arguments, Command};
use clap::Parser;
use failure::{Done, Failure};
use std::process::ExitCode;

fn main() -> ExitCode {
    // A wrong option ends here, with clap's own message and code 2.
    let arguments = Arguments::parse();
    setup::logging(matches!(&arguments.command, Command::Run(options) if options.quiet));
    let done = match arguments.command {
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
    };
    match done {
        Ok(Done::Fine) => ExitCode::SUCCESS,
        Ok(Done::Found) => ExitCode::from(1),
        Ok(Done::Interrupted) => ExitCode::from(130),
        Err(Failure { code, message }) => {
            eprintln!("error: {message}");
            ExitCode::from(code)
        }
    }
}
