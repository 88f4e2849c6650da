//! Files with the motion of meshes, read where nothing moves.

use crate::animation::FrameOptions;
use crate::error::{IoError, Place};
use crate::folder::ending;
use crate::gltf::GltfScene;
use crate::import::Import;
use crate::mesh::Mesh;
use crate::usd::Stage;
use bowknot_errors::Parameters;
use std::path::Path;

/// Whether files of this ending are stages or scenes.
pub(crate) fn is_still(ending: &str) -> bool {
    ["usda", "usd", "usdc", "usdz", "gltf", "glb"].contains(&ending)
}

/// The mesh of a stage or scene where nothing moves.
///
/// # Errors
/// As [`FrameSource::open_with`](crate::FrameSource::open_with).
pub(crate) fn read_still(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    let (mesh, _) = open_still(path, import)?;
    if let [first, second, ..] = mesh.names.as_slice() {
        let count = mesh.names.len();
        tracing::warn!(
            "{}: its {count} parts are read as one mesh: {first}, {second}, ..; `part` takes one of them",
            path.display()
        );
    }
    Ok(mesh)
}

/// The same, whose parts are its bodies, and the paths of the parts if they have some.
pub(crate) fn open_still(path: &Path, import: &Import) -> Result<(Mesh, Vec<String>), IoError> {
    import.validate().map_err(|errors| IoError::content(path, Place::File, errors.to_string()))?;
    let options = FrameOptions { import: *import, ..FrameOptions::default() };
    let (mut mesh, paths) = match ending(path).as_str() {
        "gltf" | "glb" => (GltfScene::open(path, &options)?.into_mesh(), Vec::new()),
        _ => Stage::open(path, &options)?.into_mesh(),
    };
    import.convert(&mut mesh, path)?;
    Ok((mesh, paths))
}
