//! The frames of a folder or an archive, read one at a time.

use crate::error::IoError;
use crate::folder::files_in;
use crate::import::Import;
use crate::mesh::Mesh;
#[cfg(feature = "npz")]
use crate::npz::FrameStack;
use crate::read::read_mesh;
use std::path::{Path, PathBuf};

/// Endings of frames that are files of their own, the preferred one first.
const ENDINGS: [&str; 2] = ["ply", "obj"];

/// Where frames are.
#[derive(Clone, Debug)]
pub struct FrameSource {
    store: Store,
}

#[derive(Clone, Debug)]
enum Store {
    /// In natural order, none of it empty.
    Files(Vec<PathBuf>),
    /// An archive, which can only be read as a whole.
    #[cfg(feature = "npz")]
    Archive(PathBuf, Box<FrameStack>),
}

impl FrameSource {
    /// The PLY files of a folder, else its OBJ files; `None` if it has neither or is none.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn of_folder(folder: &Path) -> Result<Option<Self>, IoError> {
        if folder.is_dir() {
            for ending in ENDINGS {
                let files = files_in(folder, &[ending])?;
                if !files.is_empty() {
                    return Ok(Some(Self { store: Store::Files(files) }));
                }
            }
        }
        Ok(None)
    }

    /// The frames of an archive; `None` if it holds none.
    ///
    /// # Errors
    /// As [`FrameStack::read`].
    #[cfg(feature = "npz")]
    pub fn of_archive(path: &Path) -> Result<Option<Self>, IoError> {
        let stack = FrameStack::read(path)?;
        let store = Store::Archive(path.to_owned(), Box::new(stack));
        Ok(Some(Self { store }).filter(|source| !source.is_empty()))
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        match &self.store {
            Store::Files(files) => files.len(),
            #[cfg(feature = "npz")]
            Store::Archive(_, stack) => stack.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Ending of the files: `ply`, `obj` or `npz`.
    pub fn ending(&self) -> String {
        self.path(0).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
    }

    /// File that holds a frame.
    pub fn path(&self, index: usize) -> &Path {
        match &self.store {
            Store::Files(files) => &files[index],
            #[cfg(feature = "npz")]
            Store::Archive(path, _) => path,
        }
    }

    /// Numbers of the frames: their names where all of these are numbers, else 0, 1, ..
    pub fn numbers(&self) -> Vec<usize> {
        let named: Option<Vec<usize>> = match &self.store {
            Store::Files(files) => {
                files.iter().map(|file| file.file_stem()?.to_str()?.parse().ok()).collect()
            }
            #[cfg(feature = "npz")]
            Store::Archive(..) => None,
        };
        named.unwrap_or_else(|| (0..self.len()).collect())
    }

    /// A frame as a mesh.
    ///
    /// # Errors
    /// As [`read_mesh`].
    pub fn read(&self, index: usize) -> Result<Mesh, IoError> {
        match &self.store {
            Store::Files(files) => read_mesh(&files[index], &Import::default()),
            #[cfg(feature = "npz")]
            Store::Archive(_, stack) => Ok(stack.frame_mesh(index)),
        }
    }
}
