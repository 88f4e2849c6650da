//! `cargo xtask peers`: the same scenes in other solvers and in Bowknot, judged alike: `tests/peers`.
//!
//! The solvers are Python packages in an environment of their own. Their runs take minutes each and are no part of
//! CI; the tests of the scripts are.

use crate::workspace::target_folder;
use crate::{bowknot, venv};
use std::io::{Error, Result};
use std::path::Path;
use std::process::{Command, ExitCode};

/// Makes the runs that are not there yet, judges all, and writes what `docs/judge.md` shows of them. The options go
/// to the script.
pub fn run(root: &Path, options: &[&str]) -> ExitCode {
    match simulate_and_judge(root, &target_folder(root), options) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn simulate_and_judge(root: &Path, target: &Path, options: &[&str]) -> Result<bool> {
    let command = bowknot::build(root).map_err(Error::other)?;
    let (scripts, environment) = (root.join("tests/peers"), target.join("xtask/peers"));
    venv::ensure(&environment, &scripts.join("requirements.txt"))?;
    let mut python = Command::new(venv::python(&environment));
    python.arg(scripts.join("run.py")).arg("--bowknot").arg(command).args(options);
    Ok(python.status()?.success())
}

/// The tests of what the scripts in `folder` do without the solvers, in the environment of the readers, which has
/// NumPy.
pub fn tests(root: &Path, target: &Path, folder: &str) -> Command {
    let mut command = Command::new(venv::python(&target.join("xtask/readers")));
    command.args(["-m", "unittest", "discover", "--quiet"]).current_dir(root.join(folder));
    command
}
