//! All frames of a run in one archive.

use super::archive::{Archive, write_archive};
use crate::error::IoError;
use crate::mesh::{Mesh, MeshView};
use bowknot_geometry::Point;
use ndarray::{Array1, Array2, ArrayView3};
use std::path::Path;

/// A stack of frames over one topology: `X[f,n,3]`, `F[m,3]`, `E[k,2]`, `T[t,4]`, `P[p]`, `O[n]`.
///
/// Frames are kept in memory (24 bytes per vertex and frame) and written as one archive, whenever asked; runs
/// write with [`super::write_frame_stack`], which keeps one frame only.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameStack {
    vertices: usize,
    positions: Vec<f64>,
    triangles: Vec<[u32; 3]>,
    strands: Vec<[u32; 2]>,
    tetrahedra: Vec<[u32; 4]>,
    particles: Vec<u32>,
    obstacle: Vec<bool>,
}

impl FrameStack {
    /// An empty stack over the elements of `mesh`, quads as two triangles each. Its positions are not taken
    /// and may be left out: the first frame then says how many vertices there are.
    pub fn new(mesh: &MeshView<'_>, tetrahedra: &[[u32; 4]]) -> Self {
        let vertices = mesh.positions.len();
        let quads = mesh.quads.iter().flat_map(|&[i, j, k, l]| [[i, j, k], [i, k, l]]);
        Self {
            vertices,
            positions: Vec::new(),
            triangles: mesh.triangles.iter().copied().chain(quads).collect(),
            strands: mesh.strands.to_vec(),
            tetrahedra: tetrahedra.to_vec(),
            particles: mesh.particles.to_vec(),
            obstacle: mesh.obstacle.to_vec(),
        }
    }

    /// Reads an archive written by [`FrameStack::write`], or any with `X[f,n,3]` or `X[n,3]`, all else
    /// optional.
    ///
    /// # Errors
    /// A missing or malformed archive, misshapen arrays, numbers out of range; with the array.
    pub fn read(path: &Path) -> Result<Self, IoError> {
        let mut archive = Archive::open(path)?;
        let Some((positions, shape)) = archive.array("X")? else {
            return Err(archive.file_fault("array X is missing"));
        };
        let vertices = match shape.as_slice() {
            [n, 3] | [_, n, 3] if *n > 0 => *n,
            _ => return Err(archive.fault("X", format!("its shape is {shape:?}, it must be [f, n, 3]"))),
        };
        if let Some(index) = positions.iter().position(|c| !c.is_finite()) {
            let (frame, vertex) = (index / (3 * vertices), index / 3 % vertices);
            return Err(archive.fault("X", format!("frame {frame}, vertex {vertex} is not finite")));
        }
        let triangles = archive.elements("F", vertices)?;
        let strands = archive.elements("E", vertices)?;
        let tetrahedra = archive.elements("T", vertices)?;
        let particles = archive.elements::<1>("P", vertices)?.into_iter().flatten().collect();
        let obstacle = archive.column("O", Some(vertices))?;
        let obstacle =
            obstacle.map_or_else(|| vec![false; vertices], |o| o.iter().map(|&f| f != 0.0).collect());
        Ok(Self { vertices, positions, triangles, strands, tetrahedra, particles, obstacle })
    }

    /// Appends a frame; one of another number of vertices is refused.
    #[must_use]
    pub fn push(&mut self, positions: &[Point]) -> bool {
        if self.vertices == 0 {
            self.vertices = positions.len();
            self.obstacle.resize(self.vertices, false);
        }
        if positions.len() != self.vertices {
            return false;
        }
        self.positions.extend(positions.iter().flat_map(|p| [p.x, p.y, p.z]));
        true
    }

    /// Drops the frames from `count` on.
    pub fn truncate(&mut self, count: usize) {
        self.positions.truncate(count.saturating_mul(3 * self.vertices));
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.positions.len() / (3 * self.vertices).max(1)
    }

    /// Whether there are no frames.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The positions of a frame [m].
    pub fn frame(&self, index: usize) -> Option<Vec<Point>> {
        let size = 3 * self.vertices;
        let values = self.positions.get(index.checked_mul(size)?..)?.get(..size)?;
        Some(values.as_chunks::<3>().0.iter().map(|&p| Point::from(p)).collect())
    }

    /// The elements, over no positions.
    pub fn mesh(&self) -> MeshView<'_> {
        MeshView {
            triangles: &self.triangles,
            strands: &self.strands,
            particles: &self.particles,
            obstacle: &self.obstacle,
            ..MeshView::default()
        }
    }

    /// A frame with its elements; without vertices if there is no such frame.
    pub fn frame_mesh(&self, index: usize) -> Mesh {
        Mesh {
            positions: self.frame(index).unwrap_or_default(),
            triangles: self.triangles.clone(),
            strands: self.strands.clone(),
            particles: self.particles.clone(),
            obstacle: Some(self.obstacle.clone()),
            ..Mesh::default()
        }
    }

    /// Writes all frames as one stored (not deflated) archive, atomically.
    ///
    /// # Errors
    /// The system's refusal, with the path.
    pub fn write(&self, path: &Path) -> Result<(), IoError> {
        write_archive(path, false, |archive| {
            if let Ok(frames) = ArrayView3::from_shape((self.len(), self.vertices, 3), &self.positions) {
                archive.add_array("X", &frames)?;
            }
            archive.add_array("F", &element_table(&self.triangles))?;
            archive.add_array("E", &element_table(&self.strands))?;
            archive.add_array("T", &element_table(&self.tetrahedra))?;
            archive.add_array("P", &Array1::from_iter(self.particles.iter().map(|&p| p as i32)))?;
            archive.add_array("O", &Array1::from_iter(self.obstacle.iter().copied()))
        })
    }
}

/// Elements as an array of one row each.
pub(super) fn element_table<const N: usize>(rows: &[[u32; N]]) -> Array2<i32> {
    Array2::from_shape_fn((rows.len(), N), |(i, k)| rows[i][k] as i32)
}
