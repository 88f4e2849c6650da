//! Calls of git.

use std::path::Path;
use std::process::Command;

/// Standard output of a git command in `folder`, without white space at its end; none if the command fails.
pub fn output(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(folder).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim_end().to_owned())
}
