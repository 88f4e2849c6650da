//! `cargo xtask notebooks`: executes the notebooks of `docs/notebooks`, and writes their outputs into them.
//!
//! The wheel is built and installed into an environment of its own, beside what the notebooks need.

use crate::venv;
use crate::wheel;
use crate::workspace::target_folder;
use std::io::{Error, Result};
use std::path::Path;
use std::process::{Command, ExitCode};

/// Where the notebooks are.
const FOLDER: &str = "docs/notebooks";

/// Executes the named notebooks, or all if no name is given.
pub fn run(root: &Path, names: &[&str]) -> ExitCode {
    match execute(root, &target_folder(root), names) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn execute(root: &Path, target: &Path, names: &[&str]) -> Result<()> {
    if !wheel::build(&mut wheel::command(root, target))? {
        return Err(Error::other("maturin built no wheel"));
    }
    let environment = target.join("xtask/notebooks");
    venv::ensure(&environment, &root.join(FOLDER).join("requirements.txt"))?;
    let wheel = wheel::newest(target)?;
    venv::install(&environment, &["--force-reinstall".as_ref(), "--no-deps".as_ref(), wheel.as_os_str()])?;
    let mut command = Command::new(venv::python(&environment));
    let done = command.arg(root.join(FOLDER).join("execute.py")).args(names).status()?;
    if done.success() { Ok(()) } else { Err(Error::other("the notebooks were not all executed")) }
}
