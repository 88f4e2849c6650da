//! Exports of a small run, read back by third-party readers: `tests/readers`.
//!
//! The readers are Python packages. They are installed into a virtual environment in the target folder, and
//! again whenever their `requirements.txt` changes.

use crate::bowknot;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// If this variable is set, as `.ci/run` does, the step fails without Python instead of being skipped.
const REQUIRED: &str = "BOWKNOT_REQUIRE_READERS";

/// Whether the step runs: if Python can run it, or if [`REQUIRED`] is set.
pub fn wanted() -> bool {
    let can = Command::new("python3")
        .args(["-c", "import ensurepip, sys; sys.exit(sys.version_info < (3, 11))"])
        .stderr(Stdio::null())
        .status();
    std::env::var_os(REQUIRED).is_some() || can.is_ok_and(|status| status.success())
}

/// `bowknot export` of the run in `target/xtask/drape`.
pub fn export(target: &Path) -> Command {
    let mut command = Command::new(bowknot::path(target));
    command.arg("export").arg(target.join("xtask/drape")).args(["--format", "obj,npz,pc2,usd,vtu", "--out"]);
    command.arg(target.join("xtask/exports"));
    command
}

/// Reads what [`export`] wrote, then frames with strands and particles, which the script makes itself.
pub fn read(root: &Path, target: &Path) -> Command {
    let mut command = Command::new(environment(target).join("bin").join("python"));
    command.arg(root.join("tests/readers/read_exports.py"));
    command.arg(target.join("xtask/drape")).arg(target.join("xtask/exports"));
    command.arg("--bowknot").arg(bowknot::path(target));
    command
}

/// Makes the virtual environment unless it is up to date, then runs the command of [`read`] in it.
pub fn run(command: &mut Command) -> Result<bool> {
    let python = PathBuf::from(command.get_program());
    let script = command.get_args().next().map(PathBuf::from).unwrap_or_default();
    let requirements = script.with_file_name("requirements.txt");
    let folder = python.ancestors().nth(2).map(Path::to_owned).unwrap_or_default();
    let wanted = std::fs::read_to_string(&requirements)?;
    let installed = folder.join("installed.txt");
    if std::fs::read_to_string(&installed).ok().as_ref() != Some(&wanted) {
        succeed(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder))?;
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"];
        succeed(Command::new(&python).args(pip).arg(&requirements))?;
        std::fs::write(&installed, wanted)?;
    }
    Ok(command.status()?.success())
}

fn environment(target: &Path) -> PathBuf {
    target.join("xtask/readers")
}

fn succeed(command: &mut Command) -> Result<()> {
    if command.status()?.success() { Ok(()) } else { Err(Error::other(format!("{command:?} failed"))) }
}
