//! A mesh that is given by its arrays.

use super::mesh::TriangleMesh;
use crate::kind::BodyKind;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, check_elements};
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};

/// A mesh by its arrays, for callers that have it in memory. Its elements are those of the body's kind:
/// triangles, tetrahedra, or strand edges; without any, each point is a particle. Of tetrahedra an obstacle
/// takes the surface. Indices count from 0.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MeshArrays {
    /// Vertices [m].
    pub positions: Vec<Point>,
    /// Triangles; on closed meshes counter-clockwise seen from outside. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<[u32; 3]>,
    /// Tetrahedra, in either handedness. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tets: Vec<[u32; 4]>,
    /// Strand edges. Default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<[u32; 2]>,
}

impl From<TriangleMesh> for MeshArrays {
    /// The surface, such as of [`super::RoundCones`], whose single cone is a capsule.
    fn from(mesh: TriangleMesh) -> Self {
        Self::surface(mesh.positions, mesh.triangles)
    }
}

impl MeshArrays {
    /// A surface.
    pub fn surface(positions: Vec<Point>, triangles: Vec<[u32; 3]>) -> Self {
        Self { positions, triangles, ..Self::default() }
    }

    /// A volume.
    pub fn volume(positions: Vec<Point>, tets: Vec<[u32; 4]>) -> Self {
        Self { positions, tets, ..Self::default() }
    }

    /// Strands.
    pub fn strands(positions: Vec<Point>, edges: Vec<[u32; 2]>) -> Self {
        Self { positions, edges, ..Self::default() }
    }

    /// Particles.
    pub fn points(positions: Vec<Point>) -> Self {
        Self { positions, ..Self::default() }
    }

    /// The kind of body that it makes, by its elements.
    pub fn kind(&self) -> BodyKind {
        match self {
            _ if !self.tets.is_empty() => BodyKind::Solid,
            _ if !self.triangles.is_empty() => BodyKind::Cloth,
            _ if !self.edges.is_empty() => BodyKind::Strands,
            _ => BodyKind::Particles,
        }
    }

    /// The mesh, as files hold it.
    pub fn mesh(&self) -> Mesh {
        let Self { positions, triangles, tets, edges } = self.clone();
        let loose = if self.kind() == BodyKind::Particles { positions.len() } else { 0 };
        let particles = (0..loose as u32).collect();
        Mesh { positions, triangles, tets, strands: edges, particles, ..Mesh::default() }
    }
}

impl Parameters for MeshArrays {
    fn check(&self, checks: &mut Checks) {
        let Self { positions, triangles, tets, edges } = self;
        if positions.is_empty() {
            checks.contradiction("positions", "a mesh needs vertices");
        }
        if let Some((vertex, x)) =
            positions.iter().enumerate().find(|(_, x)| !x.iter().all(|c| c.is_finite()))
        {
            let given = format!("vertex {vertex} at ({}, {}, {})", x.x, x.y, x.z);
            checks.refuse("positions", given, "must be finite");
        }
        let count = positions.len();
        let faults = [
            ("triangles", check_elements("triangle", triangles, count).next()),
            ("tets", check_elements("tetrahedron", tets, count).next()),
            ("edges", check_elements("edge", edges, count).next()),
        ];
        for (field, fault) in faults {
            if let Some(fault) = fault {
                checks.contradiction(field, fault);
            }
        }
    }
}
