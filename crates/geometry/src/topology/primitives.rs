//! The primitives of a scene and how they are numbered.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// The primitives of a scene over one array of vertices.
///
/// Every vertex of a triangle or a strand is part of vertex-triangle pairs; every edge of a triangle or a
/// strand, of edge-edge pairs; and every particle (a vertex of no edge), of vertex-vertex, vertex-edge and
/// vertex-triangle pairs. A vertex in none of the lists does not collide. [`Topology::builder`] fills all
/// lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Topology {
    /// Number of vertices.
    pub vertex_count: usize,
    /// Vertices of each triangle, in the order given.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices of each edge, smaller index first, sorted and unique: edges of triangles and strands.
    pub edges: Vec<[u32; 2]>,
    /// Edges of each triangle: of its vertices 0-1, 1-2, 2-0.
    pub triangle_edges: Vec<[u32; 3]>,
    /// Edges that belong to no triangle, as indices into `edges`, ascending.
    pub strand_edges: Vec<u32>,
    /// Vertices that belong to no edge but collide as points, ascending.
    pub particles: Vec<u32>,
    /// Vertices that collide: in any triangle, edge, or the particle list; ascending.
    pub surface_vertices: Vec<u32>,
}
