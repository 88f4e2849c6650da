//! Topology of triangle meshes, strands and particles: vertices, edges, triangles, adjacency.

mod adjacency;
mod tets;

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

pub use adjacency::{Components, EdgeTriangles};
pub use tets::boundary_triangles;

/// What is wrong with the elements given to [`Topology::new`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TopologyError {
    /// An element names a vertex that does not exist.
    #[error("{element} {index} names vertex {vertex}, but there are only {vertex_count} vertices")]
    VertexOutOfRange {
        /// "triangle", "strand edge" or "particle".
        element: &'static str,
        /// Which of them.
        index: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// An element names the same vertex twice.
    #[error("{element} {index} names vertex {vertex} twice")]
    RepeatedVertex {
        /// "triangle" or "strand edge".
        element: &'static str,
        /// Which of them.
        index: usize,
        /// The vertex it repeats.
        vertex: u32,
    },
}

/// The primitives of a scene over one array of vertices.
///
/// Every vertex of a triangle or a strand takes part in vertex-triangle pairs; every edge, of
/// triangles and strands alike, in edge-edge pairs; particles (vertices of no edge) in
/// vertex-vertex, vertex-edge and vertex-triangle pairs. A vertex in none of the lists is inert.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

impl Topology {
    /// Builds the topology from triangles, strand edges and particles over `vertex_count` vertices.
    ///
    /// # Errors
    /// Every index out of range and every repeated vertex within an element is reported.
    pub fn new(
        vertex_count: usize,
        triangles: Vec<[u32; 3]>,
        strands: &[[u32; 2]],
        particles: &[u32],
    ) -> Result<Self, Vec<TopologyError>> {
        let mut errors = Vec::new();
        check_elements("triangle", &triangles, vertex_count, &mut errors);
        check_elements("strand edge", strands, vertex_count, &mut errors);
        for (index, &vertex) in particles.iter().enumerate() {
            if vertex as usize >= vertex_count {
                errors.push(TopologyError::VertexOutOfRange {
                    element: "particle",
                    index,
                    vertex,
                    vertex_count,
                });
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }

        let sorted = |a: u32, b: u32| if a < b { [a, b] } else { [b, a] };
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|&[i, j, k]| [sorted(i, j), sorted(j, k), sorted(k, i)])
            .chain(strands.iter().map(|&[i, j]| sorted(i, j)))
            .collect();
        edges.sort_unstable();
        edges.dedup();

        let edge_index = |a: u32, b: u32| {
            // Present by construction of `edges` just above.
            edges.binary_search(&sorted(a, b)).map_or(u32::MAX, |e| e as u32)
        };
        let triangle_edges: Vec<[u32; 3]> = triangles
            .iter()
            .map(|&[i, j, k]| [edge_index(i, j), edge_index(j, k), edge_index(k, i)])
            .collect();

        let mut in_triangle = vec![false; edges.len()];
        triangle_edges.iter().flatten().for_each(|&e| in_triangle[e as usize] = true);
        let strand_edges = (0..edges.len() as u32).filter(|&e| !in_triangle[e as usize]).collect();

        let mut in_edge = vec![false; vertex_count];
        edges.iter().flatten().for_each(|&v| in_edge[v as usize] = true);
        let mut particles: Vec<u32> = particles.iter().copied().filter(|&v| !in_edge[v as usize]).collect();
        particles.sort_unstable();
        particles.dedup();
        particles.iter().for_each(|&v| in_edge[v as usize] = true);
        let surface_vertices = (0..vertex_count as u32).filter(|&v| in_edge[v as usize]).collect();

        Ok(Self { vertex_count, triangles, edges, triangle_edges, strand_edges, particles, surface_vertices })
    }
}

fn check_elements<const N: usize>(
    element: &'static str,
    elements: &[[u32; N]],
    vertex_count: usize,
    errors: &mut Vec<TopologyError>,
) {
    for (index, vertices) in elements.iter().enumerate() {
        for (k, &vertex) in vertices.iter().enumerate() {
            if vertex as usize >= vertex_count {
                errors.push(TopologyError::VertexOutOfRange { element, index, vertex, vertex_count });
            }
            if vertices[..k].contains(&vertex) {
                errors.push(TopologyError::RepeatedVertex { element, index, vertex });
            }
        }
    }
}
