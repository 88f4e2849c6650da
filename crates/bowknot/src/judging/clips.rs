//! Which frames a path stands for, in which order.

use super::error::JudgingError;
use super::params::JudgingParams;
use crate::io::{FrameSource, IoError, MESH_ENDINGS, files_in};
use crate::recording::States;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Files whose frames follow one another.
#[derive(Debug)]
pub(super) struct Clip {
    /// In order, one at least.
    files: Vec<PathBuf>,
    /// Files that were opened already: the parts of one scene, or what only the whole folder tells.
    source: Option<FrameSource>,
    /// Whether the straight paths between frames are those that the vertices took.
    pub is_trace: bool,
}

/// The content of a file.
pub(super) enum Frames {
    Meshes(FrameSource),
    Problem(Box<States>),
}

impl Clip {
    /// The clips of all paths; one, if their files are parts of one scene.
    pub fn all_of(paths: &[PathBuf], params: &JudgingParams) -> Result<Vec<Self>, JudgingError> {
        if params.together {
            let open = |path: &PathBuf| FrameSource::open_with(path, &params.frames);
            let sources = paths.iter().map(open).collect::<Result<Vec<_>, _>>()?;
            let source = FrameSource::together(sources)?;
            return Ok(vec![Self { files: paths[..1].to_vec(), source: Some(source), is_trace: false }]);
        }
        let clips = paths.iter().map(|path| Self::of_path(path, params));
        Ok(clips.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    }

    /// A single file, the frames of a folder, or the frames and the trace of a run.
    fn of_path(path: &Path, params: &JudgingParams) -> Result<Vec<Self>, JudgingError> {
        if !path.is_dir() {
            return Ok(vec![Self { files: vec![path.to_owned()], source: None, is_trace: false }]);
        }
        let mut clips = Vec::new();
        for folder in [path.join("frames"), path.join("trace")] {
            if folder.is_dir() {
                clips.extend(Self::of_folder(&folder)?);
            }
        }
        // In the folder of a run this finds `frames.npz`, in any other folder its frames.
        clips.extend(Self::of_folder(path)?);
        if clips.is_empty() {
            // Point caches, whose meshes lie beside them.
            let source = FrameSource::open_with(path, &params.frames)?;
            clips.push(Self { files: vec![path.to_owned()], source: Some(source), is_trace: false });
        }
        Ok(clips)
    }

    /// The frames directly in a folder, in natural order; none if it has none, or point caches.
    fn of_folder(folder: &Path) -> Result<Option<Self>, IoError> {
        if !files_in(folder, &["pc2"])?.is_empty() {
            return Ok(None);
        }
        let mut files = files_in(folder, &["ply", "obj", "npz"])?;
        // Frames that a run wrote in two formats are the same states: the binary ones, which are exact, count.
        let is = |file: &PathBuf, ending| file.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending));
        let binary: BTreeSet<PathBuf> =
            files.iter().filter(|file| is(file, "ply")).map(|file| file.with_extension("")).collect();
        files.retain(|file| !is(file, "obj") || !binary.contains(&file.with_extension("")));
        // Other formats, one of them.
        let mut endings = MESH_ENDINGS.into_iter();
        while files.is_empty()
            && let Some(ending) = endings.next()
        {
            files = files_in(folder, &[ending])?;
        }
        // The canonical path has a file name even where the argument ends with a dot, as `trace/.` does.
        let real = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let is_trace = real.file_name().is_some_and(|n| n == "trace");
        Ok((!files.is_empty()).then_some(Self { files, source: None, is_trace }))
    }

    /// Its files; the first path alone if it was opened as a whole.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// What the mesh is called whose frames these are: the file, or the folder of several.
    pub fn name(&self) -> String {
        let folder = || self.files[0].canonicalize().ok()?.parent()?.file_name().map(ToOwned::to_owned);
        let of_several = if self.files.len() > 1 { folder() } else { None };
        let name = of_several.or_else(|| self.files[0].file_stem().map(ToOwned::to_owned));
        name.unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Number of frames, if each file has one.
    pub fn len(&self) -> usize {
        self.source.as_ref().map_or(self.files.len(), FrameSource::len)
    }

    /// Opens one of its files.
    pub fn open(&self, file: &Path, params: &JudgingParams) -> Result<Frames, JudgingError> {
        if let Some(source) = &self.source {
            return Ok(Frames::Meshes(source.clone()));
        }
        if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("npz")) && States::are_in(file)? {
            return Ok(Frames::Problem(Box::new(States::read(file)?)));
        }
        Ok(Frames::Meshes(FrameSource::open_with(file, &params.frames)?))
    }
}
