//! Which frames a path stands for.

use super::cache::PointCaches;
use super::collection::Collection;
use super::{FrameSource, Store};
use crate::error::{IoError, Place};
use crate::gltf::GltfScene;
use crate::import::Import;
use crate::mesh::Mesh;
use crate::read::MESH_ENDINGS;
use crate::usd::Stage;
use bowknot_errors::Parameters;
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

impl FrameSource {
    /// The frames of any file or folder, as it says them; see [`Self::open_with`].
    ///
    /// # Errors
    /// As [`Self::open_with`].
    pub fn open(path: &Path) -> Result<Self, IoError> {
        Self::open_with(path, &FrameOptions::default())
    }

    /// The frames of
    ///
    /// - a mesh of any format that [`read_mesh`](crate::read_mesh) reads: one frame;
    /// - a point cache `NAME.pc2`, with its mesh `NAME.obj` or `NAME.ply` beside it;
    /// - a glTF scene `.gltf` or `.glb`, each node with a mesh a part, as its first animation moves them;
    /// - a USD stage `.usda`, or `.usd` if it is text, each mesh, set of curves or points a part;
    /// - a collection `.pvd` of VTK files with their times;
    /// - an archive `.npz`;
    /// - a folder of meshes of one ending (PLY, else OBJ, else VTU, else another), or of point caches; the
    ///   folder of a run, with the folder `frames`, `frames.npz` or the folder `pc2` in it.
    ///
    /// What does not move is read once. Times come with [`Self::times`], names of parts with [`Self::names`].
    ///
    /// # Errors
    /// A path without frames, or none at all; malformed files, with the place.
    pub fn open_with(path: &Path, options: &FrameOptions) -> Result<Self, IoError> {
        let fault = |message: String| IoError::content(path, Place::File, message);
        options.import.validate().map_err(|errors| fault(errors.to_string()))?;
        if options.rate.is_some_and(|rate| !(rate.is_finite() && rate > 0.0)) {
            return Err(fault("the number of frames per second must be finite and above 0".to_owned()));
        }
        let metadata = std::fs::metadata(path).map_err(|error| IoError::system("read", path, error))?;
        let source = if metadata.is_dir() { of_folder(path)? } else { of_file(path, options)? };
        Ok(Self { import: options.import, ..source })
    }
}

/// The mesh of a stage or scene where nothing moves.
///
/// # Errors
/// As [`FrameSource::open_with`].
pub(crate) fn read_still(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    import.validate().map_err(|errors| IoError::content(path, Place::File, errors.to_string()))?;
    let options = FrameOptions { import: *import, ..FrameOptions::default() };
    let mut mesh = match ending(path).as_str() {
        "gltf" | "glb" => GltfScene::open(path, &options)?.into_mesh(),
        _ => Stage::open(path, &options)?.into_mesh(),
    };
    import.convert(&mut mesh, path)?;
    Ok(mesh)
}

fn of_file(path: &Path, options: &FrameOptions) -> Result<FrameSource, IoError> {
    match ending(path).as_str() {
        "npz" => of_archive(path),
        "pc2" => PointCaches::open(&[path.to_owned()]).map(FrameSource::of_animation),
        "gltf" | "glb" => GltfScene::open(path, options).map(FrameSource::of_animation),
        "usda" | "usd" | "usdc" | "usdz" => Stage::open(path, options).map(FrameSource::of_animation),
        "pvd" => Collection::open(path).map(FrameSource::of_animation),
        _ => Ok(FrameSource { store: Store::Files(vec![path.to_owned()]), import: Import::default() }),
    }
}

/// The ending of a file's name in lower case.
fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn of_folder(folder: &Path) -> Result<FrameSource, IoError> {
    for folder in [folder.join("frames"), folder.to_owned()] {
        if let Some(frames) = FrameSource::of_folder(&folder)? {
            // Point caches lie beside the meshes that they move.
            let caches = crate::files_in(&folder, &["pc2"])?;
            return match caches.as_slice() {
                [] => Ok(frames),
                caches => PointCaches::open(caches).map(FrameSource::of_animation),
            };
        }
    }
    let archive = folder.join("frames.npz");
    if cfg!(feature = "npz") && archive.is_file() {
        return of_archive(&archive);
    }
    let caches = folder.join("pc2");
    if caches.is_dir() {
        let caches = crate::files_in(&caches, &["pc2"])?;
        if !caches.is_empty() {
            return PointCaches::open(&caches).map(FrameSource::of_animation);
        }
    }
    if let Some(frames) = FrameSource::of_files(folder, MESH_ENDINGS)? {
        return Ok(frames);
    }
    let endings = MESH_ENDINGS.map(|ending| format!(".{ending}")).join(", ");
    let message = format!("no frames in it: neither files {endings} nor frames.npz, nor in frames/ or pc2/");
    Err(IoError::content(folder, Place::File, message))
}

#[cfg(feature = "npz")]
fn of_archive(path: &Path) -> Result<FrameSource, IoError> {
    let frames = FrameSource::of_archive(path)?;
    frames.ok_or_else(|| IoError::content(path, Place::File, "it has no frames"))
}

#[cfg(not(feature = "npz"))]
fn of_archive(path: &Path) -> Result<FrameSource, IoError> {
    let message = "archives are not read: this build has no feature npz";
    Err(IoError::content(path, Place::File, message))
}

/// Times of frames of an animation with these key times, ascending: the keys, or so many per second from the
/// first to the last.
pub(crate) fn frame_times(keys: &[f64], rate: Option<f64>) -> Vec<f64> {
    let (Some(rate), [first, .., last]) = (rate, keys) else { return keys.to_vec() };
    // Rounding must not lose the last frame.
    let count = ((last - first) * rate * (1.0 + 1e-9)).floor();
    (0..).map(f64::from).take_while(|k: &f64| *k <= count).map(|k| first + k / rate).collect()
}
