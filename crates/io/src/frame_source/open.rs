//! Which frames a path stands for.

use super::cache::PointCaches;
use super::collection::Collection;
use super::{FrameSource, Store};
use crate::animation::FrameOptions;
use crate::error::{IoError, Place};
use crate::folder::ending;
use crate::gltf::GltfScene;
use crate::import::Import;
use crate::read::MESH_ENDINGS;
use crate::usd::Stage;
use bowknot_errors::Parameters;
use std::path::Path;

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
