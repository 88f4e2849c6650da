#![doc = include_str!("../README.md")]
//!
//! ## Names
//!
//! Function names follow one pattern: `module::pair_kind`, for example [`distance::vertex_triangle`].

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod bounds;
mod collision_model;
pub mod distance;
mod frame_points;
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

pub use bowknot_errors::Errors;
/// The crate of the types [`Point`] and [`Vector`].
pub use nalgebra;

pub use bounds::Aabb;
pub use collision_model::{BodyFilter, CollisionModel, ModelError};
pub use distance::Closest;
pub use frame_points::{add_frame_points, carried_frame_point, transported};
pub use half_space::HalfSpace;
pub use identity::Identity;
pub use mesh_check::{MeshProblem, check_mesh};
pub use mesh_structure::{MeshBorder, MeshEdge, MeshPart, MeshStructure};
pub use pair::PairKind;
pub use point::{Point, Vector};
pub use separation::{Separation, TriangleFeature, TriangleSeparation};
pub use tet_check::{SharedSide, TetFaults, check_tets};
pub use topology::{
    Components, EdgeTriangles, TETRAHEDRON_EDGES, Topology, TopologyBuilder, TopologyError, add_edge_middles,
    boundary_triangles, check_elements, divide_tetrahedron,
};
pub use union_find::UnionFind;
pub use vertex_range::VertexOutOfRange;
