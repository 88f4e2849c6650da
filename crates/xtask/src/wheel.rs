//! `cargo xtask wheel`: the Python package as a release uploads it, and its tests.
//!
//! Maturin builds the wheel in the target folder and the release profile of the workspace. The tests run in an
//! environment into which the wheel is installed, so that they see what users get.

use crate::workspace::target_folder;
use crate::{bowknot, licenses, venv};
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// The crate of the package.
const CRATE: &str = "crates/python";

/// Builds the wheel and prints its path; tests it as well if asked to.
pub fn run(root: &Path, with_tests: bool) -> ExitCode {
    match build_and_test(root, &target_folder(root), with_tests) {
        Ok(wheel) => {
            println!("{}", wheel.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn build_and_test(root: &Path, target: &Path, with_tests: bool) -> Result<PathBuf> {
    if !build(&mut command(root, target))? {
        return Err(Error::other("maturin built no wheel"));
    }
    if with_tests {
        bowknot::build(root).map_err(Error::other)?;
        if !test(&mut tests(root, target))? {
            return Err(Error::other("the tests of the Python package failed"));
        }
    }
    newest(target)
}

/// Builds the wheel, into `target/wheels`.
pub fn command(root: &Path, target: &Path) -> Command {
    let mut command = Command::new(venv::python(&environment(target)));
    command.args(["-m", "maturin", "build", "--release", "--locked", "--manifest-path"]);
    command.arg(root.join(CRATE).join("Cargo.toml")).arg("--out").arg(wheels(target));
    command.current_dir(root);
    command
}

/// Makes the environment with maturin unless it is up to date, then runs the command of [`command`] in it.
pub fn build(command: &mut Command) -> Result<bool> {
    let folder = venv::folder(Path::new(command.get_program()));
    let root = command.get_current_dir().unwrap_or(Path::new("."));
    venv::ensure(&folder, &root.join(CRATE).join("tests/requirements.txt"))?;
    // Maturin takes files of this name into the wheel.
    licenses::write(root, &["bowknot-python"], &[], licenses::HOST, &root.join(CRATE))?;
    // Those of earlier builds.
    for wheel in command.get_args().last().map(Path::new).into_iter().flat_map(found) {
        std::fs::remove_file(wheel)?;
    }
    Ok(command.status()?.success())
}

/// Runs the tests of the package, which compare it with the command.
pub fn tests(root: &Path, target: &Path) -> Command {
    let mut command = Command::new(venv::python(&environment(target)));
    // Not from the folder of the sources, which hold no compiled part.
    command.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]).arg(root.join(CRATE).join("tests"));
    command.env("BOWKNOT_COMMAND", bowknot::path(target)).current_dir(target);
    command
}

/// Installs the wheel that was built last, then runs the command of [`tests`].
pub fn test(command: &mut Command) -> Result<bool> {
    let folder = venv::folder(Path::new(command.get_program()));
    let target = command.get_current_dir().unwrap_or(Path::new("."));
    let wheel = newest(target)?;
    venv::install(&folder, &["--force-reinstall".as_ref(), "--no-deps".as_ref(), wheel.as_os_str()])?;
    Ok(command.status()?.success())
}

fn environment(target: &Path) -> PathBuf {
    target.join("xtask/python")
}

fn wheels(target: &Path) -> PathBuf {
    target.join("wheels")
}

/// The wheel of the last build.
pub fn newest(target: &Path) -> Result<PathBuf> {
    let folder = wheels(target);
    found(&folder).pop().ok_or_else(|| Error::other(format!("{} holds none", folder.display())))
}

/// The wheels of the package in a folder.
fn found(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_ours = |name: &str| name.starts_with("bowknot-") && name.ends_with(".whl");
    let wheels = entries.filter(|entry| entry.file_name().to_str().is_some_and(is_ours));
    wheels.map(|entry| entry.path()).collect()
}
