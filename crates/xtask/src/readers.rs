//! Exports of a small run, read back by third-party readers: `tests/readers`.
//!
//! The readers are Python packages in an environment of their own.

use crate::{bowknot, venv};
use std::io::Result;
use std::path::{Path, PathBuf};
use std::process::Command;

/// `bowknot export` of the run in `target/xtask/drape`.
pub fn export(target: &Path) -> Command {
    let mut command = Command::new(bowknot::path(target));
    command.arg("export").arg(target.join("xtask/drape")).args(["--format", "obj,npz,pc2,usd,vtu", "--out"]);
    command.arg(target.join("xtask/exports"));
    command
}

/// Reads what [`export`] wrote, then frames with strands and particles, which the script makes itself.
pub fn read(root: &Path, target: &Path) -> Command {
    let mut command = Command::new(venv::python(&target.join("xtask/readers")));
    command.arg(root.join("tests/readers/read_exports.py"));
    command.arg(target.join("xtask/drape")).arg(target.join("xtask/exports"));
    command.arg("--bowknot").arg(bowknot::path(target));
    command
}

/// Makes the virtual environment unless it is up to date, then runs the command of [`read`] in it.
pub fn run(command: &mut Command) -> Result<bool> {
    let script = command.get_args().next().map(PathBuf::from).unwrap_or_default();
    let folder = venv::folder(Path::new(command.get_program()));
    venv::ensure(&folder, &script.with_file_name("requirements.txt"))?;
    Ok(command.status()?.success())
}
