//! Virtual environments of Python in the target folder.
//!
//! Each has the packages of a `requirements.txt`, and is made again whenever that changes.

use crate::workspace::succeed;
use std::io::Result;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// If this variable is set, as `.ci/run` does, steps fail without Python instead of being skipped.
const REQUIRED: &str = "BOWKNOT_REQUIRE_READERS";

/// Whether steps that need Python run: if it is there with `venv`, or if [`REQUIRED`] is set.
pub fn wanted() -> bool {
    let can = Command::new("python3")
        .args(["-c", "import ensurepip, sys; sys.exit(sys.version_info < (3, 11))"])
        .stderr(Stdio::null())
        .status();
    std::env::var_os(REQUIRED).is_some() || can.is_ok_and(|status| status.success())
}

/// The interpreter of an environment.
pub fn python(folder: &Path) -> PathBuf {
    if cfg!(windows) { folder.join("Scripts/python.exe") } else { folder.join("bin/python") }
}

/// The folder of the environment of an interpreter.
pub fn folder(python: &Path) -> PathBuf {
    python.ancestors().nth(2).map(Path::to_owned).unwrap_or_default()
}

/// Makes the environment unless it is up to date.
pub fn ensure(folder: &Path, requirements: &Path) -> Result<()> {
    let wanted = std::fs::read_to_string(requirements)?;
    let installed = folder.join("installed.txt");
    if std::fs::read_to_string(&installed).ok().as_ref() == Some(&wanted) {
        return Ok(());
    }
    succeed(Command::new("python3").args(["-m", "venv", "--clear"]).arg(folder))?;
    install(folder, &["--requirement".as_ref(), requirements.as_os_str()])?;
    std::fs::write(&installed, wanted)
}

/// Installs packages into an environment.
pub fn install(folder: &Path, arguments: &[&std::ffi::OsStr]) -> Result<()> {
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    succeed(Command::new(python(folder)).args(pip).args(arguments))
}
