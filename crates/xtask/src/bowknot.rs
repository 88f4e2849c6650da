//! The command of this workspace, built in the release profile.

use crate::workspace::{cargo, target_folder};
use std::path::{Path, PathBuf};

/// Where cargo puts the command.
pub fn path(target: &Path) -> PathBuf {
    target.join("release").join("bowknot").with_extension(std::env::consts::EXE_EXTENSION)
}

/// Builds the command unless it is up to date, and returns its path.
pub fn build(root: &Path) -> Result<PathBuf, String> {
    let status = cargo(root, "build --quiet --release --package bowknot-cli")
        .status()
        .map_err(|error| format!("cannot start cargo: {error}"))?;
    if status.success() {
        Ok(path(&target_folder(root)))
    } else {
        Err("the command could not be built: cargo build --release --package bowknot-cli failed".to_owned())
    }
}
