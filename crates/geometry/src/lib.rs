//! Geometry of simplices for collision handling.
//!
//! The crate knows points and simplices, closest points and distances of the pair kinds (vertex-vertex,
//! vertex-edge, vertex-triangle, edge-edge, vertex-half-space), *certified* lower bounds of distances, exact
//! intersection predicates, the topology of triangle meshes, strands and particles, and which bodies may
//! collide. It does not know files, threads or time.
//!
//! ```
//! use bowknot_geometry::{PairKind, Point, separation::separate};
//!
//! let vertex = Point::new(0.25, 0.25, 1e-3);
//! let triangle = [Point::origin(), Point::new(1.0, 0.0, 0.0), Point::new(0.0, 1.0, 0.0)];
//! let pair = separate(PairKind::VertexTriangle, &[vertex, triangle[0], triangle[1], triangle[2]]);
//! assert_eq!(pair.weights, [1.0, 0.5, 0.25, 0.25]);
//! assert!(pair.width <= 1e-3 && pair.width > 0.999e-3); // never above the true distance
//! ```
//!
//! Function names follow one pattern: `module::pair_kind`, for example [`distance::vertex_triangle`].

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod bounds;
mod collision_model;
pub mod distance;
pub mod half_space;
mod identity;
pub mod intersection;
pub mod mesh_check;
mod mesh_structure;
pub mod pair;
mod point;
pub mod separation;
pub mod tet_check;
pub mod topology;
mod union_find;
mod vertex_range;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use bowknot_errors::Errors;
/// The crate of the types [`Point`] and [`Vector`].
pub use nalgebra;

pub use bounds::Aabb;
pub use collision_model::{BodyFilter, CollisionModel, ModelError};
pub use distance::Closest;
pub use half_space::HalfSpace;
pub use identity::Identity;
pub use mesh_check::{MeshProblem, check_mesh};
pub use mesh_structure::{MeshBorder, MeshEdge, MeshPart, MeshStructure};
pub use pair::PairKind;
pub use point::{Point, Vector};
pub use separation::Separation;
pub use tet_check::{SharedSide, TetFaults, check_tets};
pub use topology::{
    Components, EdgeTriangles, TETRAHEDRON_EDGES, Topology, TopologyBuilder, TopologyError, add_edge_middles,
    boundary_triangles, check_elements, divide_tetrahedron,
};
pub use union_find::UnionFind;
pub use vertex_range::VertexOutOfRange;
