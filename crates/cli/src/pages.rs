//! `bowknot completions` and `bowknot man`: what shells and manuals know of the command, from its arguments.

use crate::args::{Arguments, CompletionsOptions, ManOptions};
use crate::exit::{Exit, Failure};
use crate::output;
use clap::CommandFactory;
use std::fs;

pub fn completions(options: &CompletionsOptions) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut Arguments::command(), "bowknot", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Exit::Success)
}

pub fn man(options: &ManOptions) -> Result<Exit, Failure> {
    let folder = &options.folder;
    let fault = |error| Failure::input(format!("cannot write {}: {error}", folder.display()));
    fs::create_dir_all(folder).map_err(fault)?;
    clap_mangen::generate_to(Arguments::command(), folder).map_err(fault)?;
    Ok(Exit::Success)
}
