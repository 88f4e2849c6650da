//! Topology of triangle meshes, strands and particles: vertices, edges, triangles, adjacency.

mod adjacency;
mod builder;
mod error;
mod primitives;
mod tets;

pub use adjacency::{Components, EdgeTriangles};
pub use builder::TopologyBuilder;
pub use error::{TopologyError, check_elements};
pub use primitives::Topology;
pub use tets::{TETRAHEDRON_EDGES, add_edge_middles, boundary_triangles, divide_tetrahedron};

#[cfg(test)]
mod tests;
