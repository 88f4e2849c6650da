//! Point caches with the meshes that they move.

use crate::animation::Animation;
use crate::error::{IoError, Place};
use crate::import::Import;
use crate::mesh::Mesh;
use crate::parts::PartsBuilder;
use crate::pc2::PointCache;
use crate::read::read_mesh;
use bowknot_errors::counted;
use std::path::{Path, PathBuf};

/// Point caches of the same number of samples, each a part.
#[derive(Debug)]
pub(super) struct PointCaches {
    caches: Vec<PointCache>,
    /// The meshes, put together, at the first sample.
    mesh: Mesh,
    samples: usize,
}

impl PointCaches {
    /// Opens caches with the meshes beside them: of the same name, with the ending `obj` or `ply`.
    ///
    /// # Errors
    /// Files that are missing or malformed, meshes of other numbers of vertices, caches of different numbers
    /// of samples, or of none.
    pub fn open(paths: &[PathBuf]) -> Result<Self, IoError> {
        let mut builder = PartsBuilder::default();
        let mut caches: Vec<PointCache> = Vec::with_capacity(paths.len());
        for path in paths {
            let fault = |message: String| IoError::content(path, Place::File, message);
            let cache = PointCache::open(path)?;
            let meshes = ["obj", "ply"].map(|ending| path.with_extension(ending));
            let mesh_path = meshes.iter().find(|mesh| mesh.is_file()).ok_or_else(|| {
                fault(format!(
                    "a point cache moves a mesh: neither {} nor {} is there",
                    meshes[0].display(),
                    meshes[1].display()
                ))
            })?;
            let mut mesh = read_mesh(mesh_path, &Import::default())?;
            if mesh.positions.len() != cache.points() {
                return Err(fault(format!(
                    "it moves {}, but {} has {}",
                    counted(cache.points(), "point", "points"),
                    mesh_path.display(),
                    counted(mesh.positions.len(), "vertex", "vertices")
                )));
            }
            if let Some(first) = caches.first()
                && first.samples() != cache.samples()
            {
                return Err(fault(format!(
                    "it has {}, {} has {}: open them one by one",
                    counted(cache.samples(), "sample", "samples"),
                    first.path().display(),
                    first.samples()
                )));
            }
            if cache.samples() == 0 {
                return Err(fault("it has no samples".to_owned()));
            }
            mesh.positions = cache.read(0)?;
            mesh.triangulate();
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let overflow = || fault("more vertices than can be counted in 32 bits".to_owned());
            builder.add(mesh, name).ok_or_else(overflow)?;
            caches.push(cache);
        }
        let samples = caches.first().map_or(0, PointCache::samples);
        Ok(Self { caches, mesh: builder.finish(), samples })
    }
}

impl Animation for PointCaches {
    fn len(&self) -> usize {
        self.samples
    }

    fn times(&self) -> Option<&[f64]> {
        None
    }

    fn names(&self) -> &[String] {
        &self.mesh.names
    }

    fn path(&self, _index: usize) -> &Path {
        self.caches[0].path()
    }

    fn read(&self, index: usize) -> Result<Mesh, IoError> {
        let mut positions = Vec::with_capacity(self.mesh.positions.len());
        for cache in &self.caches {
            positions.append(&mut cache.read(index)?);
        }
        Ok(Mesh { positions, ..self.mesh.clone() })
    }
}
