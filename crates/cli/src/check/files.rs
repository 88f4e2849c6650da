//! Which files are checked, in which order.

use crate::exit::Failure;
use bowknot::io::files_in;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Files that are checked in order. If they are a trace, the straight paths between them are checked too.
#[derive(Clone, Debug)]
pub struct Group {
    pub files: Vec<PathBuf>,
    pub trace: bool,
}

/// The groups of an argument: a single file, the frames of a folder, or the frames and the trace of a run.
pub fn groups_of(path: &Path) -> Result<Vec<Group>, Failure> {
    if !path.is_dir() {
        return Ok(vec![Group { files: vec![path.to_owned()], trace: false }]);
    }
    let mut groups = Vec::new();
    for folder in [path.join("frames"), path.join("trace")] {
        if folder.is_dir() {
            groups.extend(frames_in(&folder)?);
        }
    }
    // In the folder of a run this finds `frames.npz`, in any other folder its frames.
    groups.extend(frames_in(path)?);
    if groups.is_empty() {
        let message = "no frames (.ply, .obj, .npz) in it, nor in frames/ or trace/ below it";
        return Err(Failure::input(format!("{}: {message}", path.display())));
    }
    Ok(groups)
}

/// The frames directly in a folder, in natural order.
fn frames_in(folder: &Path) -> Result<Option<Group>, Failure> {
    let mut files = files_in(folder, &["ply", "obj", "npz"])?;
    // Frames that a run wrote in two formats are the same states: the binary ones, which are exact, count.
    let binary: BTreeSet<PathBuf> =
        files.iter().filter(|file| extension(file) == "ply").map(|file| file.with_extension("")).collect();
    files.retain(|file| extension(file) != "obj" || !binary.contains(&file.with_extension("")));
    // The canonical path has a file name even where the argument ends with a dot, as `trace/.` does.
    let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let trace = real.file_name().is_some_and(|n| n == "trace");
    Ok((!files.is_empty()).then_some(Group { files, trace }))
}

pub fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}
