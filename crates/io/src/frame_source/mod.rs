//! The frames of a folder, a file or an archive, read one at a time.

mod cache;
mod collection;
mod open;
mod together;

use crate::animation::Animation;
use crate::error::IoError;
use crate::folder::files_in;
use crate::import::Import;
use crate::mesh::Mesh;
#[cfg(feature = "npz")]
use crate::npz::FrameStack;
use crate::read::{MESH_ENDINGS, read_mesh};
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Endings of frames that are files of their own, the preferred one first; `vtu` if it is read.
const ENDINGS: [&str; 3] = ["ply", "obj", "vtu"];

/// Where frames are.
#[derive(Clone, Debug)]
pub struct FrameSource {
    store: Store,
    import: Import,
}

#[derive(Clone, Debug)]
enum Store {
    /// In natural order, none of it empty.
    Files(Vec<PathBuf>),
    /// An archive, which can only be read as a whole.
    #[cfg(feature = "npz")]
    Archive(PathBuf, Box<FrameStack>),
    /// A file that tells the frames of a mesh.
    Animation(Arc<dyn Animation>),
}

impl FrameSource {
    /// The PLY files of a folder, else its OBJ files, else its VTU files; `None` if it has none or is no
    /// folder.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn of_folder(folder: &Path) -> Result<Option<Self>, IoError> {
        Self::of_files(folder, ENDINGS.into_iter().filter(|ending| MESH_ENDINGS.contains(ending)))
    }

    /// The files of a folder with the first of these endings that it has.
    fn of_files<'a>(
        folder: &Path,
        endings: impl IntoIterator<Item = &'a str>,
    ) -> Result<Option<Self>, IoError> {
        if folder.is_dir() {
            for ending in endings {
                let files = files_in(folder, &[ending])?;
                if !files.is_empty() {
                    return Ok(Some(Self { store: Store::Files(files), import: Import::default() }));
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
        Ok(Some(Self { store, import: Import::default() }).filter(|source| !source.is_empty()))
    }

    pub(crate) fn of_animation(animation: impl Animation + 'static) -> Self {
        Self { store: Store::Animation(Arc::new(animation)), import: Import::default() }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        match &self.store {
            Store::Files(files) => files.len(),
            #[cfg(feature = "npz")]
            Store::Archive(_, stack) => stack.len(),
            Store::Animation(animation) => animation.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Ending of the files, in lower case: `ply`, `npz`, `usda`, ..
    pub fn ending(&self) -> String {
        self.path(0).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
    }

    /// File that holds a frame.
    pub fn path(&self, index: usize) -> &Path {
        match &self.store {
            Store::Files(files) => &files[index],
            #[cfg(feature = "npz")]
            Store::Archive(path, _) => path,
            Store::Animation(animation) => animation.path(index),
        }
    }

    /// Numbers of the frames: their names where all of these are numbers, else 0, 1, ..
    pub fn numbers(&self) -> Vec<usize> {
        let named: Option<Vec<usize>> = match &self.store {
            Store::Files(files) => {
                files.iter().map(|file| file.file_stem()?.to_str()?.parse().ok()).collect()
            }
            _ => None,
        };
        named.unwrap_or_else(|| (0..self.len()).collect())
    }

    /// Time of each frame [s], ascending; `None` if the files do not know it.
    pub fn times(&self) -> Option<&[f64]> {
        match &self.store {
            Store::Animation(animation) => animation.times(),
            _ => None,
        }
    }

    /// Time code of each frame, of a USD stage in which something moves; `None` for other files.
    pub fn codes(&self) -> Option<&[f64]> {
        match &self.store {
            Store::Animation(animation) => animation.codes(),
            _ => None,
        }
    }

    /// Names of the parts that [`Mesh::body`] counts: prims of a USD stage, nodes of a glTF scene, files of a
    /// folder of point caches. None for frames that are files of their own, whose meshes have the names, and
    /// for archives.
    pub fn names(&self) -> &[String] {
        match &self.store {
            Store::Animation(animation) => animation.names(),
            _ => &[],
        }
    }

    /// Paths of the parts, if they have some: those of a USD stage.
    pub fn paths(&self) -> &[String] {
        match &self.store {
            Store::Animation(animation) => animation.paths(),
            _ => &[],
        }
    }

    /// A frame as a mesh, one of those counted by [`Self::len`].
    ///
    /// # Errors
    /// As [`read_mesh`].
    pub fn read(&self, index: usize) -> Result<Mesh, IoError> {
        let mut mesh = match &self.store {
            Store::Files(files) => return read_mesh(&files[index], &self.import),
            #[cfg(feature = "npz")]
            Store::Archive(_, stack) => stack.frame_mesh(index),
            Store::Animation(animation) => animation.read(index)?,
        };
        self.import.convert(&mut mesh, self.path(index))?;
        Ok(mesh)
    }
}
