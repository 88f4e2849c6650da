//! Writing files so that a reader sees the old content or the new, never half of it.

use crate::error::IoError;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Distinguishes the temporary files of one process.
static COUNTER: AtomicU32 = AtomicU32::new(0);

/// Writes a file through `fill` into a temporary file in the same folder, which then takes the name of
/// `path`.
///
/// An interrupted or failed write leaves an older file of that name as it was. The file is not synchronized
/// to the disk: the promise covers the process being stopped and the disk being full, not the power failing.
///
/// # Errors
/// Whatever `fill` or the system reports; the temporary file is then removed.
pub fn write_atomic(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<(), IoError> {
    let temporary = temporary_name(path);
    let written = File::create(&temporary).and_then(|file| {
        let mut writer = BufWriter::with_capacity(1 << 18, file);
        fill(&mut writer)?;
        writer.flush()?;
        fs::rename(&temporary, path)
    });
    written.map_err(|source| {
        // The file may not exist; the first error is the one to report.
        let _ = fs::remove_file(&temporary);
        IoError::system("write", path, source)
    })
}

/// Writes a text file atomically.
///
/// # Errors
/// As [`write_atomic`].
pub fn write_text(path: &Path, text: &str) -> Result<(), IoError> {
    write_atomic(path, |writer| writer.write_all(text.as_bytes()))
}

/// Creates a folder and those above it.
///
/// # Errors
/// The system's refusal, with the path.
pub fn create_folder(path: &Path) -> Result<(), IoError> {
    fs::create_dir_all(path).map_err(|source| IoError::system("create", path, source))
}

/// `.NAME.PROCESS-COUNT.part` beside `path`: hidden, and no reader takes its ending for a frame.
fn temporary_name(path: &Path) -> PathBuf {
    let count = COUNTER.fetch_add(1, Ordering::Relaxed);
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}-{count}.part", std::process::id()));
    path.with_file_name(name)
}
