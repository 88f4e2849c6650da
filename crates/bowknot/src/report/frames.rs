//! The frames of a run's folder, read one at a time.

use super::ReportError;
use crate::io::{FrameStack, Import, IoError, Mesh, natural_order, read_mesh};
use std::fs;
use std::path::{Path, PathBuf};

/// Where the frames are.
pub(super) struct Frames {
    folder: PathBuf,
    store: Store,
}

enum Store {
    /// Number and path of each, ascending.
    Files(Vec<(usize, PathBuf)>),
    /// `frames.npz`, which can only be read as a whole.
    Stack(Box<FrameStack>),
}

impl Frames {
    /// Finds `frames/*.ply`, else `frames/*.obj`, else `frames.npz`.
    pub(super) fn find(folder: &Path) -> Result<Self, ReportError> {
        let here = |store| Self { folder: folder.to_owned(), store };
        let inner = folder.join("frames");
        if inner.is_dir() {
            for ending in ["ply", "obj"] {
                let files = files(&inner, ending)?;
                if !files.is_empty() {
                    return Ok(here(Store::Files(files)));
                }
            }
        }
        let archive = folder.join("frames.npz");
        if archive.exists() {
            let stack = FrameStack::read(&archive)?;
            if !stack.is_empty() {
                return Ok(here(Store::Stack(Box::new(stack))));
            }
        }
        Err(ReportError::NoFrames { path: folder.to_owned() })
    }

    pub(super) fn len(&self) -> usize {
        match &self.store {
            Store::Files(files) => files.len(),
            Store::Stack(stack) => stack.len(),
        }
    }

    /// The time step that made a frame; 0 is the initial state.
    pub(super) fn number(&self, index: usize) -> usize {
        match &self.store {
            Store::Files(files) => files[index].0,
            Store::Stack(_) => index,
        }
    }

    pub(super) fn path(&self, index: usize) -> PathBuf {
        match &self.store {
            Store::Files(files) => files[index].1.clone(),
            Store::Stack(_) => self.folder.join("frames.npz"),
        }
    }

    pub(super) fn read(&self, index: usize) -> Result<Mesh, IoError> {
        match &self.store {
            Store::Files(files) => read_mesh(&files[index].1, &Import::default()),
            Store::Stack(stack) => {
                let view = stack.mesh();
                Ok(Mesh {
                    positions: stack.frame(index).unwrap_or_default(),
                    triangles: view.triangles.to_vec(),
                    strands: view.strands.to_vec(),
                    particles: view.particles.to_vec(),
                    tets: Vec::new(),
                    obstacle: Some(view.obstacle.to_vec()),
                    body: None,
                })
            }
        }
    }
}

/// Files with this ending in natural order, numbered by their names where these are numbers, else by their place.
fn files(folder: &Path, ending: &str) -> Result<Vec<(usize, PathBuf)>, IoError> {
    let unreadable = |source| IoError::system("read", folder, source);
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        let fits = path.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        // Files that start with a dot are being written.
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if fits && !stem.starts_with('.') && path.is_file() {
            files.push((stem, path));
        }
    }
    files.sort_by(|a, b| natural_order(&a.0, &b.0));
    let numbers: Option<Vec<usize>> = files.iter().map(|(stem, _)| stem.parse().ok()).collect();
    let numbers = numbers.unwrap_or_else(|| (0..files.len()).collect());
    Ok(numbers.into_iter().zip(files.into_iter().map(|(_, path)| path)).collect())
}
