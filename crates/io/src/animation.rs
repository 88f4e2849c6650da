//! Files with the motion of meshes.

use crate::error::IoError;
use crate::import::Import;
use crate::mesh::Mesh;
use std::fmt::Debug;
use std::path::Path;

/// How frames are read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameOptions {
    /// From the axes and the unit of the files to ours. By default they stay as they are.
    pub import: Import,
    /// Frames per second of a file that knows motion but no frames [1/s], a USD stage or a glTF scene; none:
    /// frames at the times of its samples or keys, each once.
    pub rate: Option<f64>,
    /// Whether vertices of a glTF mesh stay apart that are the same in position, all morph targets and skin.
    /// Exporters part them where texture coordinates or normals differ; by default they are joined.
    pub keep_seams: bool,
}

/// A file, or several that belong together, with the motion of meshes. Lengths and axes are the file's.
pub(crate) trait Animation: Debug + Send + Sync {
    /// Number of frames.
    fn len(&self) -> usize;

    /// Time of each frame [s], if the file knows it.
    fn times(&self) -> Option<&[f64]>;

    /// Time code of each frame, if the file has them.
    fn codes(&self) -> Option<&[f64]> {
        None
    }

    /// Names of the parts, by their numbers in [`Mesh::body`].
    fn names(&self) -> &[String];

    /// Paths of the parts, likewise, if they have some.
    fn paths(&self) -> &[String] {
        &[]
    }

    /// File that holds a frame.
    fn path(&self, index: usize) -> &Path;

    /// A frame, which exists. All have the same elements, unless they come from files of their own.
    fn read(&self, index: usize) -> Result<Mesh, IoError>;
}

/// Times of frames of an animation with these key times, ascending: the keys, or so many per second from the
/// first to the last.
pub(crate) fn frame_times(keys: &[f64], rate: Option<f64>) -> Vec<f64> {
    let (Some(rate), [first, .., last]) = (rate, keys) else { return keys.to_vec() };
    // Rounding must not lose the last frame.
    let count = ((last - first) * rate * (1.0 + 1e-9)).floor();
    (0..).map(f64::from).take_while(|k: &f64| *k <= count).map(|k| first + k / rate).collect()
}
