//! Several sources as one: the parts of a scene that lie in files of their own.

use super::FrameSource;
use crate::animation::Animation;
use crate::error::{IoError, Place};
use crate::mesh::Mesh;
use crate::parts::PartsBuilder;
use bowknot_errors::counted;
use std::path::Path;

/// Sources of one frame, which stand still, and others of equally many frames.
#[derive(Debug)]
struct Together {
    sources: Vec<FrameSource>,
    /// The meshes of those that stand still.
    still: Vec<Option<Mesh>>,
    /// The source that tells the number of frames and their times.
    moving: usize,
}

impl FrameSource {
    /// The frames of several sources, put together one by one; sources of one frame stand still. Parts have
    /// the names that their meshes tell, else that of the file.
    ///
    /// # Errors
    /// No source, moving ones of different numbers of frames, more vertices than 32 bits count; files that
    /// cannot be read.
    pub fn together(sources: Vec<Self>) -> Result<Self, IoError> {
        let longest = |index: &usize| sources[*index].len();
        let Some(moving) = (0..sources.len()).rev().max_by_key(longest) else {
            return Err(IoError::content(Path::new(""), Place::File, "no files to put together"));
        };
        let frames = sources[moving].len();
        if let Some(other) = sources.iter().find(|source| source.len() > 1 && source.len() != frames) {
            let (path, count) = (sources[moving].path(0), counted(frames, "frame", "frames"));
            let message = format!(
                "it has {count}, {} has {}: what moves together must have as many",
                other.path(0).display(),
                other.len()
            );
            return Err(IoError::content(path, Place::File, message));
        }
        let still = |source: &Self| -> Result<Option<Mesh>, IoError> {
            if frames > 1 && source.len() > 1 {
                return Ok(None);
            }
            let mut mesh = source.read(0)?;
            if mesh.body.is_none() {
                mesh.triangulate();
            }
            Ok(Some(mesh))
        };
        let still = sources.iter().map(still).collect::<Result<Vec<_>, _>>()?;
        Ok(Self::of_animation(Together { sources, still, moving }))
    }
}

impl Animation for Together {
    fn len(&self) -> usize {
        self.sources[self.moving].len()
    }

    fn times(&self) -> Option<&[f64]> {
        self.sources[self.moving].times()
    }

    fn codes(&self) -> Option<&[f64]> {
        self.sources[self.moving].codes()
    }

    fn names(&self) -> &[String] {
        // The meshes have them.
        &[]
    }

    fn path(&self, index: usize) -> &Path {
        self.sources[self.moving].path(index)
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        let mut builder = PartsBuilder::default();
        for (source, still) in self.sources.iter().zip(&self.still) {
            let mesh = still.as_ref().map_or_else(|| source.read(index), |mesh| Ok(mesh.clone()))?;
            let path = source.path(if still.is_some() { 0 } else { index });
            let name = part_name(source, path);
            let overflow =
                || IoError::content(path, Place::File, "more vertices than can be counted in 32 bits");
            builder.add_bodies(mesh, name).ok_or_else(overflow)?;
        }
        Ok(builder.finish())
    }
}

/// The name of a source: that of its file, or of the folder of its frames.
fn part_name(source: &FrameSource, path: &Path) -> String {
    let folder = if source.len() > 1 && source.path(0) != source.path(1) { path.parent() } else { None };
    folder.and_then(Path::file_name).or(path.file_stem()).unwrap_or_default().to_string_lossy().into_owned()
}
