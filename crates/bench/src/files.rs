//! Writing files.

use anyhow::{Context, Result};
use std::fs;
use std::path::Path;

/// Writes a file and creates its folder if it does not exist.
pub fn write(path: &Path, text: &str) -> Result<()> {
    if let Some(parent) = path.parent() {
        fs::create_dir_all(parent).with_context(|| format!("cannot create {}", parent.display()))?;
    }
    fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
}
