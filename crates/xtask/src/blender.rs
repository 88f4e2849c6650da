//! `cargo xtask blender`: the extension for Blender as a zip, with the wheel in it, and its tests in Blender's module.

use crate::venv;
use crate::wheel;
use crate::workspace::target_folder;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Where the extension, its tests and what packs it are.
const FOLDER: &str = "crates/python/blender";

/// Packs the wheels that are given, or one that it builds, and prints the path of the zip; tests it as well if asked to.
pub fn run(root: &Path, arguments: &[&str]) -> ExitCode {
    let with_tests = arguments.contains(&"--test");
    let wheels = arguments.iter().filter(|argument| argument.ends_with(".whl")).map(PathBuf::from).collect();
    match pack_and_test(root, &target_folder(root), wheels, with_tests) {
        Ok(zip) => {
            println!("{}", zip.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Packs the wheels, or one that it builds if there are none; the path of the zip.
pub fn pack_and_test(
    root: &Path,
    target: &Path,
    mut wheels: Vec<PathBuf>,
    with_tests: bool,
) -> Result<PathBuf> {
    if wheels.is_empty() {
        if !wheel::build(&mut wheel::command(root, target))? {
            return Err(Error::other("maturin built no wheel"));
        }
        wheels.push(wheel::newest(target)?);
    }
    let mut pack = Command::new("python3");
    pack.arg(root.join(FOLDER).join("pack.py")).arg(target.join("blender")).args(&wheels);
    let packed = pack.stderr(std::process::Stdio::inherit()).output()?;
    if !packed.status.success() {
        return Err(Error::other("the extension was not packed"));
    }
    let zip = PathBuf::from(String::from_utf8_lossy(&packed.stdout).trim());
    if with_tests && !test(root, target, &zip)? {
        return Err(Error::other("the tests of the extension failed"));
    }
    Ok(zip)
}

/// Runs the tests in Blender's module, into which they install the zip as users do.
fn test(root: &Path, target: &Path, zip: &Path) -> Result<bool> {
    let tests = root.join(FOLDER).join("tests");
    let environment = target.join("xtask/blender");
    venv::ensure(&environment, &tests.join("requirements.txt"))?;
    let mut command = Command::new(venv::python(&environment));
    command.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]).arg(&tests);
    command.env("BOWKNOT_BLENDER_ZIP", zip).current_dir(target);
    Ok(command.status()?.success())
}
